#include "cli/report_time.hpp"

#include <sys/stat.h>

#include <cstdlib>

namespace arris {

std::string utc(std::time_t time) {
  std::tm parts{};
  gmtime_r(&time, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::string report_time(const std::filesystem::path& scan) {
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH"); epoch != nullptr && *epoch != '\0')
    return utc(static_cast<std::time_t>(std::strtoll(epoch, nullptr, 10)));
  struct stat status {};
  return utc(::stat(scan.c_str(), &status) == 0 ? status.st_mtime : std::time_t{0});
}

}  // namespace arris
