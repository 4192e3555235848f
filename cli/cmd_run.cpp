#include "cli/cmd_run.hpp"

#include <unistd.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <thread>

#include "acquisition/files/atomic_file.hpp"
#include "acquisition/files/sha256.hpp"
#include "acquisition/target_file.hpp"
#include "acquisition/types/error.hpp"
#include "cli/cell.hpp"
#include "cli/console.hpp"
#include "cli/contours_file.hpp"
#include "cli/in_scan.hpp"
#include "cli/pipeline.hpp"
#include "cli/report_time.hpp"
#include "cli/run_folder.hpp"
#include "cli/run_inputs.hpp"
#include "cli/run_summary.hpp"
#include "report/result_hash.hpp"
#include "report/run_log.hpp"
#include "report/verdict.hpp"

namespace arris {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kStages = 7;
constexpr const char* kMark = "result.json";

/// Stage times and the run's log, with the progress line.
class Journal {
 public:
  explicit Journal(const RunArgs& args) {
    times_.started = utc(std::time(nullptr));
    times_.threads = args.threads > 0 ? args.threads : static_cast<int>(std::thread::hardware_concurrency());
    times_.run_id = std::to_string(std::chrono::system_clock::now().time_since_epoch().count()) + "-" +
                    std::to_string(::getpid());
    times_.command_line = std::string("arris ") + (args.inspect_only ? "inspect " : "run ") +
                          args.recipe.string() + " --scan " + args.scan.string();
  }

  void stage(const std::string& what) {
    close_stage();
    progress_.stage(++step_, kStages, what);
    current_ = what;
    stage_began_ = Clock::now();
    log("info", what);
  }

  void log(const std::string& level, const std::string& text) {
    log_.push_back({utc(std::time(nullptr)), seconds_since(began_), level, current_, text});
  }

  std::vector<NamedBytes> files(const std::string& result_hash) {
    close_stage();
    times_.finished = utc(std::time(nullptr));
    times_.total_s = seconds_since(began_);
    return {{"run.json", report::write_run_json(times_, result_hash)},
            {"log.jsonl", report::write_log_jsonl(log_)}};
  }

  [[nodiscard]] double total_s() const { return seconds_since(began_); }

 private:
  static double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }
  void close_stage() {
    if (!current_.empty()) times_.stage_s.emplace_back(current_, seconds_since(stage_began_));
    current_.clear();
  }

  console::Progress progress_;
  report::RunTimes times_;
  std::vector<report::LogEntry> log_;
  Clock::time_point began_ = Clock::now(), stage_began_ = began_;
  std::string current_;
  int step_ = 0;
};

std::optional<TargetSearch> target_search(const RunArgs& args, const Recipe& recipe,
                                          const std::optional<Cell>& cell) {
  if (!cell || cell->targets.empty()) return std::nullopt;
  TargetSearch search;
  search.list = cell->targets;
  if (args.targets) search.points = read_scan_targets(*args.targets, unit_mm(recipe.scan.units));
  search.options = {cell->targets_max_residual_mm, cell->scan_points_sd_mm, cell->targets_clear_mm,
                    args.threads};
  return search;
}

std::optional<ContourChoice> operators_choice(const RunArgs& args, const Recipe& recipe) {
  if (args.contours) return read_contour_choice_for(*args.contours, sha256_file(args.scan));
  if (recipe.contour.validation == "operator")
    throw Error(Fault::kInput, {.what = "the recipe asks for contours that an operator has accepted",
                                .where = args.recipe.string(),
                                .found = "contour.validation = \"operator\", and no choice",
                                .needed = "--contours FILE",
                                .next = "make it: arris contours " + args.scan.string() +
                                        " --accept .. --out contours.json"});
  return std::nullopt;
}

fs::path default_out(const fs::path& scan) {
  return scan.stem().string() + ".arris";
}

std::string why_no_program(const RunArgs& args, const RunRecord& record, bool has_cell) {
  if (args.inspect_only) return "an inspection has no tool path";
  if (!record.accepted()) return "refused: no corrected path and no robot program are handed out";
  if (record.frame_refused()) return "no robot program was written: " + record.frame->reasons.front();
  if (!has_cell)
    return "no cell is given ([cell] file in the recipe, or --cell): no robot program was written";
  return "";
}

void fill(const AtomicFolder& folder, const std::vector<NamedBytes>& files) {
  for (const auto& [name, bytes] : files) write_file(folder.path() / name, bytes);
}

}  // namespace

int run_main_job(const RunArgs& args) {
  Journal journal(args);
  journal.stage("reading the recipe and the drawing");
  const Recipe recipe = read_recipe(args.recipe);
  std::optional<Cell> cell = read_cell_for(args, recipe);
  AtomicFolder folder(args.out.value_or(default_out(args.scan)), args.force, kMark);
  const Drawing drawing = read_drawing(recipe, !args.inspect_only, args.threads);

  journal.stage("reading the scan");
  const std::vector<InputFile> inputs = hashed_inputs(args, recipe, cell);
  const std::optional<ContourChoice> choice = operators_choice(args, recipe);
  const std::optional<TargetSearch> targets = target_search(args, recipe, cell);
  Measurement measurement =
      in_scan(args.scan, [&] { return read_measurement(recipe, args.scan, choice, targets, args.threads); });

  Processed processed = in_scan(args.scan, [&] {
    return process(recipe, drawing, measurement, args.inspect_only, args.threads,
                   [&](const std::string& what) { journal.stage(what); });
  });
  RunRecord& record = processed.record;
  record.inputs = inputs;
  if (cell) record.frame_max_residual_mm = cell->targets_max_residual_mm;
  record.report_time = report_time(args.scan);
  for (std::string& note :
       report::edge_offset_notes(record.edge_offset, record.spacing_mm, record.report_time))
    record.notes.push_back(std::move(note));
  record.result_hash = sha256_hex(report::canonical_text(record, processed.field_parameters));

  journal.stage("writing the results");
  std::vector<NamedBytes> programs;
  record.program_note = why_no_program(args, record, cell.has_value());
  if (record.program_note.empty()) {
    record.program_written = true;
    if (record.frame) cell->robot_from_scan = record.frame->robot_from_scan;
    programs = robot_programs(record, *cell, recipe.robot.controller, spin_from_name(recipe.toolpath.spin));
    for (const auto& [name, bytes] : programs)
      record.program_note += (record.program_note.empty() ? "" : ", ") + name;
  }
  for (const std::string& reason : record.refusals) journal.log("warning", reason);
  if (record.frame_refused())
    for (const std::string& reason : record.frame->reasons) journal.log("warning", reason);
  fill(folder, result_files(record));
  fill(folder, programs);
  fill(folder, journal.files(record.result_hash));
  print_summary(record, folder.target(), journal.total_s(), args.json);
  console::flush();  // a summary that nobody can have is an error, and an error leaves no folder
  folder.commit();
  return report::run_exit_code(record);
}

}  // namespace arris
