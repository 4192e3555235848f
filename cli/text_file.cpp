#include "cli/text_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "acquisition/types/error.hpp"

namespace arris {

std::string read_text_file(const std::filesystem::path& file, const std::string& kind,
                           std::uintmax_t max_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw Error(Fault::kInput, {"there is no such " + kind, file.string(), {}, {}, "check the name"});
  if (!std::filesystem::is_regular_file(status))
    throw Error(Fault::kInput,
                {"the " + kind + " is no file", file.string(), "a folder or device", "a text file", {}});
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > max_bytes)
    throw Error(Fault::kInput,
                {"the " + kind + " is too large to be one", file.string(), std::to_string(size) + " bytes",
                 "at most " + std::to_string(max_bytes), "check the name"});
  std::ifstream stream(file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), {});
  if (!stream)
    throw Error(Fault::kInput,
                {"the " + kind + " cannot be read", file.string(), {}, {}, "check its permissions"});
  return text;
}

void write_new_text_file(const std::filesystem::path& file, const std::string& text,
                         const std::string& kind) {
  const auto refuse = [&](const std::string& what, const std::string& found, const std::string& next) {
    throw Error(Fault::kInput, {what, file.string(), found, {}, next});
  };
  if (std::filesystem::exists(std::filesystem::symlink_status(file)))
    refuse("the " + kind + " exists already", {}, "choose another name, or remove it");
  const std::filesystem::path partial = file.string() + ".partial-" + std::to_string(::getpid());
  std::ofstream stream(partial, std::ios::binary);
  stream << text;
  stream.close();
  const int reason = errno;
  std::error_code error;
  if (stream) {
    std::filesystem::rename(partial, file, error);
    if (!error) return;
  }
  std::error_code ignored;
  std::filesystem::remove(partial, ignored);
  refuse("the " + kind + " cannot be written", error ? error.message() : std::strerror(reason),
         "check the folder, its permissions and the space on the disk");
}

}  // namespace arris
