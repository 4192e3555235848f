#pragma once

#include <ctime>
#include <filesystem>
#include <string>

namespace arris {

/// A time as ISO 8601, UTC: "2026-11-20T09:12:33Z".
[[nodiscard]] std::string utc(std::time_t time);

/// The date that results carry: SOURCE_DATE_EPOCH, else the scan file's time, so that equal runs give equal
/// bytes.
[[nodiscard]] std::string report_time(const std::filesystem::path& scan);

}  // namespace arris
