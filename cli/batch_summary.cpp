#include "cli/batch_summary.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "report/number_text.hpp"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

/// A figure of a run, its name in every table, and its decimals.
struct Figure {
  const char* name;
  double RunResult::*value;
};

constexpr std::array<Figure, 9> kFigures{{{"before_mean_mm", &RunResult::before_mean_mm},
                                          {"before_max_mm", &RunResult::before_max_mm},
                                          {"after_mean_mm", &RunResult::after_mean_mm},
                                          {"after_max_mm", &RunResult::after_max_mm},
                                          {"max_correction_mm", &RunResult::max_correction_mm},
                                          {"max_tilt_deg", &RunResult::max_tilt_deg},
                                          {"seen_ratio", &RunResult::seen_ratio},
                                          {"surface_profile_mm", &RunResult::surface_profile_mm},
                                          {"contour_profile_mm", &RunResult::contour_profile_mm}}};
constexpr int kDecimals = 6;  // as in result.json

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string cell(double value, int decimals) {
  return std::isfinite(value) ? report::fixed_text(value, decimals) : "";
}

std::string word_now(const BatchRow& row) {
  if (row.kept) return "kept";
  return row.run_again_because.empty() ? "run" : "run again";
}

double seconds(const BatchRow& row) {
  return row.kept && row.result ? row.result->total_s : row.wall_s;
}

Json number(double value) {
  return std::isfinite(value) ? Json(report::rounded(value)) : Json(nullptr);
}

Json row_json(const BatchRow& row) {
  Json json = {{"scan", row.scan.file.string()},
               {"folder", row.result ? Json(row.scan.name) : Json(nullptr)},
               {"exit_code", row.exit_code},
               {"outcome", outcome_word(row.exit_code)},
               {"correction", row.result ? Json(row.result->correction) : Json(nullptr)},
               {"inspection", row.result ? Json(row.result->inspection) : Json(nullptr)}};
  for (const auto& [name, value] : kFigures) json[name] = row.result ? number(*row.result.*value) : nullptr;
  json["result_hash"] = row.result ? Json(row.result->result_hash) : Json(nullptr);
  json["message"] = row.message;
  json["now"] = word_now(row);
  json["because"] = row.run_again_because;
  json["seconds"] = number(seconds(row));
  return json;
}

}  // namespace

std::string summary_csv(std::span<const BatchRow> rows) {
  std::string text = "scan,folder,exit_code,outcome,correction,inspection";
  for (const Figure& figure : kFigures) text.append(",").append(figure.name);
  text += ",result_hash,message\n";
  for (const BatchRow& row : rows) {
    const RunResult result = row.result.value_or(RunResult());
    text += cell(row.scan.file.string()) + "," + (row.result ? cell(row.scan.name) : "") + "," +
            std::to_string(row.exit_code) + "," + outcome_word(row.exit_code) + "," + result.correction +
            "," + result.inspection;
    for (const auto& [name, value] : kFigures) text += "," + cell(result.*value, kDecimals);
    text += "," + result.result_hash + "," + cell(row.message) + "\n";
  }
  return text;
}

std::string times_csv(std::span<const BatchRow> rows) {
  std::string text = "scan,now,because,seconds\n";
  for (const BatchRow& row : rows)
    text += cell(row.scan.file.string()) + "," + word_now(row) + "," + cell(row.run_again_because) + "," +
            cell(seconds(row), 3) + "\n";
  return text;
}

std::string batch_json(const BatchRecord& record) {
  Json json = {{"schema", "arris.batch/1"},
               {"part", record.part_number},
               {"recipe", record.recipe.string()},
               {"folder", record.folder.string()},
               {"exit_code", worst_exit_code(record.rows)}};
  json["counts"] = Json::object();
  for (const auto& [code, count] : outcome_counts(record.rows)) json["counts"][outcome_word(code)] = count;
  json["seconds"] = number(record.total_s);
  json["scans"] = Json::array();
  for (const BatchRow& row : record.rows) json["scans"].push_back(row_json(row));
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace arris
