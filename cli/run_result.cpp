#include "cli/run_result.hpp"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace arris {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kSchema = "arris.result/1";

Json read_json(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  return Json::parse(text);
}

double number(const Json& json, const char* pointer) {
  const Json::json_pointer at(pointer);
  if (!json.contains(at)) return RunResult::kUnknown;
  const Json& value = json.at(at);
  return value.is_number() ? value.get<double>() : RunResult::kUnknown;
}

/// Whether every file is there that a run with this outcome writes.
bool is_whole(const fs::path& folder, const Json& json) {
  std::vector<std::string> names{"report.html", "deviation.ply", "run.json", "log.jsonl"};
  if (json.at("verdicts").at("correction") == "ACCEPTED") names.emplace_back("corrected.csv");
  if (json.at("program").at("written") == true) {
    std::string listed = json.at("program").at("note");
    for (std::size_t end = 0; !listed.empty(); listed.erase(0, end == std::string::npos ? end : end + 2)) {
      end = listed.find(", ");
      names.push_back(listed.substr(0, end));
    }
  }
  std::error_code ignored;
  for (const std::string& name : names)
    if (!fs::is_regular_file(folder / name, ignored)) return false;
  return true;
}

RunResult result_of(const Json& json) {
  RunResult result;
  result.version = json.at("version");
  result.result_hash = json.at("result_hash");
  for (const Json& input : json.at("inputs"))
    result.inputs.push_back({input.at("role"), input.at("name"), input.at("sha256")});
  const Json& verdicts = json.at("verdicts");
  result.exit_code = verdicts.at("exit_code");
  result.correction = verdicts.at("correction");
  result.inspection = verdicts.at("inspection");
  result.refusals = json.at("refusals").get<std::vector<std::string>>();
  const char* judged =
      json.at("part").at("state") == "free" ? "ii_shape_as_scanned" : "iii_contour_pulled_back";
  result.inspection_text = json.at("results").at(judged).at("judged").at("text");
  if (const std::size_t colon = result.inspection_text.rfind(": "); colon != std::string::npos)
    result.inspection_text.erase(0, colon + 2);  // what is judged stands before it, the reason behind
  result.before_mean_mm = number(json, "/contour_errors/summary/before_rigid/mean_mm");
  result.before_max_mm = number(json, "/contour_errors/summary/before_rigid/max_mm");
  result.after_mean_mm = number(json, "/contour_errors/summary/after/mean_mm");
  result.after_max_mm = number(json, "/contour_errors/summary/after/max_mm");
  if (number(json, "/results/i_correction/path/from_data") +
          number(json, "/results/i_correction/path/from_prior") >
      0) {
    result.max_correction_mm = number(json, "/results/i_correction/path/max_shift_mm");
    result.max_tilt_deg = number(json, "/results/i_correction/path/max_tilt_deg");
  }
  if (const double seen = number(json, "/alignment/overlap_ratio"); seen > 0.0) result.seen_ratio = seen;
  if (number(json, "/results/ii_shape_as_scanned/deviation/count") > 0)
    result.surface_profile_mm = number(json, "/results/ii_shape_as_scanned/judged/profile_value_mm");
  if (number(json, "/results/iii_contour_pulled_back/deviation/count") > 0)
    result.contour_profile_mm = number(json, "/results/iii_contour_pulled_back/judged/profile_value_mm");
  return result;
}

}  // namespace

std::optional<RunResult> read_run_result(const fs::path& folder) {
  try {
    const Json json = read_json(folder / "result.json");
    if (json.at("schema") != kSchema || !is_whole(folder, json)) return std::nullopt;
    RunResult result = result_of(json);
    result.total_s = number(read_json(folder / "run.json"), "/total_s");
    return result;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace arris
