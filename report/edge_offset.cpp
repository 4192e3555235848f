#include "report/edge_offset.hpp"

#include <algorithm>

#include "report/number_text.hpp"

namespace arris::report {
namespace {

constexpr double kAlikeSpacingRatio = 2.0;

/// The same day a year later: dates of this form order as texts.
std::string a_year_after(const std::string& date) {
  std::string year = std::to_string(std::stoi(date.substr(0, 4)) + 1);
  year.insert(0, 4 - std::min<std::size_t>(4, year.size()), '0');
  return year + date.substr(4);
}

}  // namespace

std::string edge_offset_text(const EdgeOffset& offset) {
  if (!offset.calibrated) return "not calibrated, \u00b1" + fixed_text(offset.edge.sd_mm, 2) + " mm assumed";
  return "calibrated " + offset.date + ", " + signed_text(offset.edge.out_mm, 3) + " \u00b1 " +
         fixed_text(offset.edge.sd_mm, 3) + " mm, scanner " + offset.scanner +
         (offset.serial.empty() ? "" : " (" + offset.serial + ")");
}

std::vector<std::string> edge_offset_notes(const EdgeOffset& offset, double spacing_mm,
                                           const std::string& report_time) {
  std::vector<std::string> notes;
  if (!offset.calibrated) return notes;
  const double ratio = spacing_mm / offset.spacing_mm;
  if (ratio > kAlikeSpacingRatio || ratio < 1.0 / kAlikeSpacingRatio)
    notes.push_back("the edge offset was calibrated with points " + fixed_text(offset.spacing_mm, 2) +
                    " mm apart, this scan's are " + fixed_text(spacing_mm, 2) +
                    ": it may show edges elsewhere; calibrate with the settings that parts are scanned with");
  if (const std::string day = report_time.substr(0, 10); day > a_year_after(offset.date))
    notes.push_back("the edge offset was calibrated on " + offset.date +
                    ", more than a year before this scan (" + day + "): calibrate again");
  return notes;
}

}  // namespace arris::report
