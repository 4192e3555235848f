#include <algorithm>
#include <cmath>

#include "report/html_sections.hpp"
#include "report/html_text.hpp"
#include "report/number_text.hpp"

namespace arris::report::html {
namespace {

std::string target_row(const TargetSighting& sighting, double limit_mm) {
  const bool is_sphere = sighting.target.kind == TargetKind::kSphere;
  const double nan = std::nan("");
  const std::string what =
      is_sphere ? "sphere, " + fixed_text(sighting.target.diameter_mm, 2) + " mm" : "point";
  const std::string seen = !sighting.found ? "not found"
                           : is_sphere     ? grouped_text(sighting.points) + " points"
                                           : "given";
  return tag("tr", tag("td", tag("strong", escaped(sighting.target.id))) + tag("td", what) + tag("td", seen) +
                       tag("td", mm(sighting.found ? sighting.sd_mm : nan), "n") +
                       tag("td", mm(sighting.target.sd_mm), "n") +
                       tag("td", mm(sighting.found ? sighting.residual_mm : nan), "n") +
                       tag("td", mm(limit_mm), "n") +
                       (sighting.over_limit ? tag("td", "over", "out")
                                            : tag("td", sighting.found ? "within" : "&ndash;"))) +
         "\n";
}

std::string targets_table(const RunRecord& record) {
  std::string rows =
      "<tr><th>target</th><th>kind</th><th>in the scan</th><th class=\"n\">sd seen, mm</th>"
      "<th class=\"n\">sd of list, mm</th><th class=\"n\">residual, mm</th><th class=\"n\">limit, mm</th>"
      "<th>fit</th></tr>\n";
  for (const TargetSighting& sighting : record.frame->targets)
    rows += target_row(sighting, record.frame_max_residual_mm);
  return tag("div", tag("table", rows), "scroll");
}

/// What the frame's uncertainty is, about the middle of the targets and out at the path.
std::string uncertainty_table(const RunRecord& record) {
  const TargetFrame& frame = *record.frame;
  const auto sd = [&](int i) { return std::sqrt(std::max(0.0, frame.covariance(i, i))); };
  std::string rows = number_row({"standard deviation of the scanner's frame", "X", "Y", "Z"}, "th");
  const auto milli = [&](int i) { return fixed_text(1000.0 * sd(i), 4); };
  rows += number_row({"turn, mrad", milli(0), milli(1), milli(2)});
  rows += number_row({"move at the middle of the targets, mm", mm(sd(3)), mm(sd(4)), mm(sd(5))});
  std::string html = tag("table", rows);
  if (record.robot_sd.empty()) return html;
  RowUncertainty most;
  const auto larger = [](double& value, double other) {
    if (std::isfinite(other)) value = std::max(value, other);
  };
  for (const RowUncertainty& row : record.robot_sd) {
    larger(most.frame_mm, row.frame_mm);
    larger(most.normal_mm, row.normal_mm);
    larger(most.across_mm, row.across_mm);
  }
  const auto known = [](double value) { return value > 0.0 ? mm(value) : std::string("not known"); };
  std::string path = number_row({"largest standard deviation of a row in the robot's frame", "mm"}, "th");
  path += number_row({"what the scanner's frame adds, in its worst direction", mm(most.frame_mm)});
  path += number_row({"with the correction's own, along the tool's axis", known(most.normal_mm)});
  path += number_row({"with the correction's own, across the path", known(most.across_mm)});
  return html + tag("table", path) +
         tag("p", "Every row is in result.json, under cell. corrected.csv stays in the scan's frame.");
}

}  // namespace

std::string cell_section(const RunRecord& record) {
  if (!record.frame) return {};
  const TargetFrame& frame = *record.frame;
  std::string html = tag("h2", "Cell: the scanner's frame from fixture targets");
  if (frame.usable()) {
    html += tag("p",
                "The places of the targets in the scan, carried to the robot's base, against the list. "
                "The residual is the distance that is left.");
  } else {
    std::string items;
    for (const std::string& reason : frame.reasons) items += tag("li", escaped(reason));
    html +=
        tag("div",
            tag("strong", record.has_toolpath ? "The scanner's frame is not known. No program was written."
                                              : "The scanner's frame is not known.") +
                tag("ul", items),
            "reasons") +
        "\n";
  }
  html += targets_table(record);
  if (frame.extra > 0)
    html += tag("p", "In the scan and not in the list: " + std::to_string(frame.extra) + ".");
  if (!frame.usable()) return html;
  html += tag("h3", "robot_from_scan, file coordinates, mm") + matrix_table(frame.robot_from_scan);
  return html + uncertainty_table(record);
}

}  // namespace arris::report::html
