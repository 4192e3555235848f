#include "report/run_log.hpp"

#include <nlohmann/json.hpp>

#include "report/number_text.hpp"

namespace arris::report {
namespace {

using Json = nlohmann::ordered_json;

std::string dump(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string write_run_json(const RunTimes& times, const std::string& result_hash) {
  Json json;
  json["schema"] = "arris.run/1";
  json["run_id"] = times.run_id;
  json["result_hash"] = result_hash;
  json["started"] = times.started;
  json["finished"] = times.finished;
  json["threads"] = times.threads;
  json["command_line"] = times.command_line;
  json["total_s"] = rounded(times.total_s);
  json["stage_s"] = Json::array();
  for (const auto& [stage, seconds] : times.stage_s)
    json["stage_s"].push_back({{"stage", stage}, {"wall_s", rounded(seconds)}});
  return dump(json, 2) + "\n";
}

std::string write_log_jsonl(const std::vector<LogEntry>& entries) {
  std::string text;
  for (const LogEntry& entry : entries) {
    Json json;
    json["time"] = entry.time;
    json["elapsed_s"] = rounded(entry.elapsed_s);
    json["level"] = entry.level;
    json["stage"] = entry.stage;
    json["text"] = entry.text;
    text += dump(json, -1) + "\n";
  }
  return text;
}

}  // namespace arris::report
