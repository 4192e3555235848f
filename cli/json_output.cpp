#include "cli/json_output.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <type_traits>
#include <variant>

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

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

/// The value in a slot, in JSON's own types; null when it is not set.
Json value_json(const Key& key, const std::filesystem::path& folder) {
  if (value_text(key, folder).empty()) return nullptr;
  return std::visit(
      [&](const auto* value) -> Json {
        using Value = std::remove_cvref_t<decltype(*value)>;
        if constexpr (std::is_same_v<Value, std::optional<double>>)
          return Json(**value);
        else if constexpr (std::is_same_v<Value, std::filesystem::path>)
          return Json(
              (folder.empty() || value->empty() ? *value : value->lexically_proximate(folder)).string());
        else
          return Json(*value);
      },
      key.slot);
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

std::string keys_json(const std::string& file, const std::vector<Key>& keys,
                      const std::filesystem::path& folder, const std::set<std::string>& absent) {
  Json list = Json::array();
  for (const Key& key : keys) {
    const bool off = absent.contains(key.name.substr(0, key.name.rfind('.')));
    list.push_back({{"key", key.name},
                    {"value", off ? Json(nullptr) : value_json(key, folder)},
                    {"about", key.about},
                    {"required", key.required},
                    {"takes", type_text(key)}});
  }
  return text_of({{"file", text_or_null(file)}, {"keys", list}});
}

std::string edge_calibration_json(const std::string& file, const EdgeFile& stored,
                                  const EdgeCalibration& found) {
  Json contours = Json::array();
  for (const CalibratedContour& one : found.contours) {
    const auto used = [&](double value) { return one.used ? Json(value) : Json(nullptr); };
    contours.push_back({{"scan", one.scan + 1},
                        {"contour", one.id},
                        {"used", one.used},
                        {"seen_ratio", one.seen_ratio},
                        {"stretches", one.stretches},
                        {"out_mm", used(one.out_mm)},
                        {"scatter_mm", used(one.scatter_mm)}});
  }
  Json edge = nullptr;
  if (found.usable())
    edge = {{"out_mm", stored.edge.out_mm},   {"sd_mm", stored.edge.sd_mm}, {"spacing_mm", stored.spacing_mm},
            {"scatter_mm", found.scatter_mm}, {"date", stored.date},        {"scanner", stored.scanner},
            {"serial", stored.serial}};
  return text_of({{"file", found.usable() ? Json(file) : Json(nullptr)},
                  {"calibrated", found.usable()},
                  {"reason", found.reason},
                  {"edge", edge},
                  {"contours", contours}});
}

std::string new_recipe_json(const std::string& file, const std::string& text) {
  return text_of({{"file", text_or_null(file)}, {"recipe", text}});
}

std::string info_json(const std::string& file, const FileInfo& info) {
  const auto vector_json = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  return text_of({{"file", file},
                  {"format", info.format},
                  {"bytes", info.bytes},
                  {"sha256", info.sha256},
                  {"points", info.points},
                  {"finite", info.finite},
                  {"triangles", info.triangles},
                  {"flat_triangles", info.flat_triangles},
                  {"has_normals", info.has_normals},
                  {"has_colours", info.has_colours},
                  {"extra_names", info.extra_names},
                  {"box_min", vector_json(info.box_min)},
                  {"box_max", vector_json(info.box_max)},
                  {"extent", vector_json(info.extent())},
                  {"spacing", info.spacing},
                  {"unit_hint", info.unit_hint},
                  {"unit_guess", info.unit_guess},
                  {"notes", info.notes}});
}

std::string map_json(const MapResult& map) {
  Json motion = Json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) motion.push_back(map.scan_from_cad.matrix()(row, column));
  return text_of({{"file", map.file},
                  {"points", map.points},
                  {"points_on_drawing", map.on_drawing},
                  {"mean_mm", number(map.mean_mm)},
                  {"rms_mm", number(map.rms_mm)},
                  {"min_mm", number(map.least_mm)},
                  {"max_mm", number(map.most_mm)},
                  {"in_tolerance_ratio", number(map.in_tolerance_ratio)},
                  {"scan_from_cad", motion},
                  {"free_directions", map.free_directions}});
}

}  // namespace arris
