#pragma once

#include <string>
#include <vector>

#include "report/run_record.hpp"

namespace arris::report::html {

// The parts of report.html, in the order of the page; each returns finished HTML, or nothing when there is
// nothing.
[[nodiscard]] std::string banner(const RunRecord& record);
[[nodiscard]] std::string facts(const RunRecord& record);
[[nodiscard]] std::string three_results(const RunRecord& record);
[[nodiscard]] std::string deviation_section(const RunRecord& record);
[[nodiscard]] std::string contour_error_section(const RunRecord& record);
[[nodiscard]] std::string path_section(const RunRecord& record);
[[nodiscard]] std::string cell_section(const RunRecord& record);
[[nodiscard]] std::string worst_points_section(const RunRecord& record);
[[nodiscard]] std::string registration_section(const RunRecord& record);
[[nodiscard]] std::string notes_and_definitions(const RunRecord& record);

// Building blocks.
[[nodiscard]] std::string tag(const std::string& name, const std::string& content,
                              const std::string& css = "");
[[nodiscard]] std::string picture(const std::string& png, const std::string& alternative,
                                  const std::string& caption);
[[nodiscard]] std::string chart(const std::string& svg, const std::string& caption);
/// First cell left, the rest right-aligned as numbers; cells are finished HTML.
[[nodiscard]] std::string number_row(const std::vector<std::string>& cells, const std::string& cell = "td");
/// "0.123" or a dash for what is not known; plain text without unit.
[[nodiscard]] std::string mm(double value, int digits = 3);
[[nodiscard]] std::string signed_mm(double value, int digits = 3);
/// A motion as its four rows.
[[nodiscard]] std::string matrix_table(const RigidMotion& motion);
[[nodiscard]] std::string percent(double ratio, int digits = 1);

}  // namespace arris::report::html
