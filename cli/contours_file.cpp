#include "cli/contours_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "acquisition/types/error.hpp"
#include "cli/text_file.hpp"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kFormat = "arris contour choice 1";

Json vectors_json(const std::vector<Eigen::Vector3d>& vectors) {
  const auto rounded = [](double value) { return std::round(value * 1e6) / 1e6; };
  Json list = Json::array();
  for (const Eigen::Vector3d& v : vectors) list.push_back({rounded(v.x()), rounded(v.y()), rounded(v.z())});
  return list;
}

std::vector<Eigen::Vector3d> vectors_of(const Json& list) {
  std::vector<Eigen::Vector3d> vectors;
  for (const Json& v : list) {
    const Eigen::Vector3d point(v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>());
    if (!point.allFinite() || v.size() != 3) throw std::runtime_error("a point is not three finite numbers");
    vectors.push_back(point);
  }
  return vectors;
}

ChosenContour contour_of(const Json& json) {
  ChosenContour chosen;
  const std::string role = json.at("role").get<std::string>();
  if (role != "accept" && role != "reject") throw std::runtime_error("a role is neither accept nor reject");
  chosen.accepted = role == "accept";
  chosen.contour.id = json.at("id").get<int>();
  chosen.contour.closed = json.at("closed").get<bool>();
  chosen.contour.source = json.at("source").get<std::string>();
  chosen.contour.points_mm = vectors_of(json.at("points_mm"));
  chosen.contour.normals = vectors_of(json.at("normals"));
  if (!chosen.contour.normals.empty() && chosen.contour.normals.size() != chosen.contour.points_mm.size())
    throw std::runtime_error("points and normals differ in number");
  return chosen;
}

}  // namespace

std::vector<Contour> ContourChoice::accepted() const {
  std::vector<Contour> kept;
  for (const ChosenContour& chosen : contours)
    if (chosen.accepted) kept.push_back(chosen.contour);
  return kept;
}

ContourChoice choose(const ContourSet& contours, const std::vector<int>& accepted_ids,
                     const Eigen::Vector3d& offset_mm) {
  ContourChoice choice;
  std::vector<int> ids;
  for (const FoundContour& found : contours.found) {
    ids.push_back(found.contour.id);
    ChosenContour chosen{found.contour};
    for (Eigen::Vector3d& p : chosen.contour.points_mm) p += offset_mm;
    chosen.accepted = std::find(accepted_ids.begin(), accepted_ids.end(), ids.back()) != accepted_ids.end();
    choice.contours.push_back(std::move(chosen));
  }
  for (const int id : accepted_ids)
    if (std::find(ids.begin(), ids.end(), id) == ids.end())
      throw Error(Fault::kUsage,
                  {"there is no contour " + std::to_string(id),
                   "--accept",
                   {},
                   ids.empty() ? "the file has none" : fmt::format("one of {}", fmt::join(ids, ", ")),
                   {}});
  return choice;
}

std::string contour_choice_json(const ContourChoice& choice) {
  Json list = Json::array();
  for (const ChosenContour& chosen : choice.contours)
    list.push_back({{"id", chosen.contour.id},
                    {"role", chosen.accepted ? "accept" : "reject"},
                    {"closed", chosen.contour.closed},
                    {"source", chosen.contour.source},
                    {"points_mm", vectors_json(chosen.contour.points_mm)},
                    {"normals", vectors_json(chosen.contour.normals)}});
  const Json json = {{"format", kFormat},
                     {"file", choice.file},
                     {"sha256", choice.sha256},
                     {"to_mm", choice.to_mm},
                     {"contours", list}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

ContourChoice read_contour_choice(const std::filesystem::path& file) {
  const std::string text = read_text_file(file, "contour choice", std::uintmax_t{256} << 20);
  try {
    const Json json = Json::parse(text);
    if (json.at("format").get<std::string>() != kFormat)
      throw std::runtime_error("it has another format line");
    ContourChoice choice;
    choice.file = json.at("file").get<std::string>();
    choice.sha256 = json.at("sha256").get<std::string>();
    choice.to_mm = json.at("to_mm").get<double>();
    for (const Json& contour : json.at("contours")) choice.contours.push_back(contour_of(contour));
    return choice;
  } catch (const std::exception& error) {
    throw Error(Fault::kInput, {"this is no contour choice of arris", file.string(), error.what(),
                                "a file written by arris contours --accept", "make the choice again"});
  }
}

ContourChoice read_contour_choice_for(const std::filesystem::path& file, const std::string& sha256) {
  ContourChoice choice = read_contour_choice(file);
  if (choice.sha256 == sha256) return choice;
  throw Error(Fault::kInput, {"the contours were chosen for another scan", file.string(),
                              choice.file + ", SHA-256 " + choice.sha256.substr(0, 12),
                              "a choice for SHA-256 " + sha256.substr(0, 12),
                              "make the choice again: arris contours SCAN --accept IDS --out FILE"});
}

}  // namespace arris
