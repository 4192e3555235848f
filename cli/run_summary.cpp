#include "cli/run_summary.hpp"

#include <algorithm>
#include <cstdio>

#include "cli/console.hpp"
#include "report/statistics.hpp"
#include "report/verdict.hpp"
#include "report/write_json.hpp"

namespace arris {
namespace {

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string frame_line(const RunRecord& record) {
  if (record.frame_refused()) return "REFUSED";
  const auto& targets = record.frame->targets;
  const auto found = std::count_if(targets.begin(), targets.end(), [](const auto& t) { return t.found; });
  double worst_mm = 0.0;
  for (const TargetSighting& sighting : targets) worst_mm = std::max(worst_mm, sighting.residual_mm);
  return line("SOLVED from %d of %d fixture targets, largest residual %.3f mm (at most %.3f)",
              static_cast<int>(found), static_cast<int>(targets.size()), worst_mm,
              record.frame_max_residual_mm);
}

}  // namespace

void print_summary(const RunRecord& record, const std::filesystem::path& folder, double total_s, bool json) {
  if (json) {
    console::print(report::write_json(record));
    return;
  }
  console::print("part         " + record.part_number + "   (" + record.method + ", result " +
                 record.result_hash.substr(0, 12) + ")");
  for (const std::string& face : record.face_lines) console::print("face         " + face);
  console::print("correction   " + report::correction_word(record));
  for (const std::string& reason : record.refusals) console::print("             " + reason);
  if (record.frame && record.has_toolpath) {
    console::print("frame        " + frame_line(record));
    for (const std::string& reason : record.frame->reasons) console::print("             " + reason);
  }
  console::print("inspection   " + report::verdict_word(record.inspection_verdict()));
  const report::ContourErrorSummary errors = report::contour_error_summary(record.contour_errors);
  if (errors.rigid.count > 0) {
    console::print(line("found edge   mean %.3f mm, max %.3f mm from the nominal placed rigidly",
                        errors.rigid.mean_mm, errors.rigid.max_mm));
    console::print(
        line("             mean %.3f mm, max %.3f mm with its bending followed (%s); a scan this dense shows "
             "an edge to %.3f mm",
             errors.after.mean_mm, errors.after.max_mm, record.method.c_str(), record.edge_limit_mm));
  }
  console::print("edge offset  " + report::edge_offset_text(record.edge_offset));
  if (record.accepted() && record.method != "rigid")
    console::print("strain       " + report::strain_text(record));
  if (const std::string warning = report::permanence_warning(record); !warning.empty() && record.accepted())
    console::print("warning      " + warning);
  for (const std::string& free : record.alignment.free_directions) console::print("not determined: " + free);
  for (const std::string& step : report::next_steps(record)) console::print("next         " + step);
  if (!record.program_note.empty()) console::print("program      " + record.program_note);
  console::print(line("wrote        %s   (%.2f s)", folder.c_str(), total_s));
}

}  // namespace arris
