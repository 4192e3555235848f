#include "cli/json_output.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

/// JSON knows no infinity: a straight contour has no bend radius.
Json number(double value) {
  return std::isfinite(value) ? Json(std::round(value * 1e6) / 1e6) : Json(nullptr);
}

Json contour_json(const FoundContour& found) {
  return {{"id", found.contour.id},
          {"points", found.contour.points_mm.size()},
          {"length_mm", number(found.length_mm)},
          {"closed", found.contour.closed},
          {"closing_gap_mm", number(found.closing_gap_mm)},
          {"min_bend_radius_mm", number(found.min_bend_radius_mm)},
          {"source", found.contour.source},
          {"note", found.note}};
}

}  // namespace

std::string problems_json(const std::string& file, const std::vector<ErrorText>& problems) {
  Json list = Json::array();
  for (const ErrorText& p : problems)
    list.push_back(
        {{"what", p.what}, {"where", p.where}, {"found", p.found}, {"needed", p.needed}, {"next", p.next}});
  return text_of({{"file", file}, {"good", problems.empty()}, {"problems", list}});
}

std::string contours_json(const std::string& file, const ContourSet& contours) {
  Json found = Json::array(), dropped = Json::array();
  for (const FoundContour& contour : contours.found) found.push_back(contour_json(contour));
  for (const FoundContour& contour : contours.dropped) dropped.push_back(contour_json(contour));
  return text_of({{"file", file}, {"contours", found}, {"dropped", dropped}, {"notes", contours.notes}});
}

}  // namespace arris
