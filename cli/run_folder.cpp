#include "cli/run_folder.hpp"

#include "acquisition/files/sha256.hpp"
#include "acquisition/types/error.hpp"
#include "report/write_deviation_ply.hpp"
#include "report/write_html.hpp"
#include "report/write_json.hpp"
#include "toolpath/formats/csv.hpp"
#include "toolpath/robot/compare.hpp"
#include "toolpath/robot/dialect.hpp"
#include "toolpath/robot/program.hpp"

namespace arris {
namespace {

NamedBytes robot_program(const RunRecord& record, const Cell& cell, const Dialect& dialect, Spin spin,
                         bool dry_run) {
  const auto hash = [](std::string_view bytes) { return sha256_hex(bytes); };
  ProgramOptions options;
  options.spin = spin;
  options.dry_run = dry_run;
  options.result_hash = record.result_hash;
  options.comments = {record.version, "part " + record.part_number};
  const Program program = make_program(record.correction, record.cloud.offset_mm, cell, options);
  std::string text = dialect.write(program, hash);
  const std::string name = std::string(dry_run ? "program_dry" : "program") + dialect.extension;
  const std::vector<std::string> wrong = differences(program, dialect.read(text, name), hash);
  if (!wrong.empty())
    throw Error(
        Fault::kBug,
        {.what = "the robot program does not read back as the path", .where = name, .found = wrong.front()});
  return {name, std::move(text)};
}

}  // namespace

std::vector<NamedBytes> robot_programs(const RunRecord& record, const Cell& cell,
                                       const std::string& controller, Spin spin) {
  const Dialect& dialect = dialect_from_name(controller);
  return {robot_program(record, cell, dialect, spin, false),
          robot_program(record, cell, dialect, spin, true)};
}

std::vector<NamedBytes> result_files(const RunRecord& record) {
  std::vector<NamedBytes> files;
  files.emplace_back("result.json", report::write_json(record));
  if (record.has_toolpath && record.accepted())
    files.emplace_back("corrected.csv", write_corrected_csv(record.nominal_path, record.correction,
                                                            record.cloud.offset_mm, record.result_hash));
  files.emplace_back("deviation.ply", report::write_deviation_ply(record));
  files.emplace_back("report.html", report::write_html(record));
  return files;
}

}  // namespace arris
