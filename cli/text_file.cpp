#include "cli/text_file.hpp"

#include <fstream>
#include <iterator>

#include "acquisition/files/atomic_file.hpp"
#include "acquisition/types/error.hpp"

namespace arris {

std::string read_text_file(const std::filesystem::path& file, const std::string& kind,
                           std::uintmax_t max_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw Error(Fault::kInput, {"there is no such " + kind, file.string(), "nothing of that name",
                                "a file that exists", "check the name"});
  if (!std::filesystem::is_regular_file(status))
    throw Error(Fault::kInput, {"the " + kind + " is no file", file.string(), "a folder or device",
                                "a text file", "check the name"});
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > max_bytes)
    throw Error(Fault::kInput,
                {"the " + kind + " is too large to be one", file.string(), std::to_string(size) + " bytes",
                 "at most " + std::to_string(max_bytes), "check the name"});
  std::ifstream stream(file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), {});
  if (!stream)
    throw Error(Fault::kInput,
                {"the " + kind + " cannot be read", file.string(), "a file that gives no bytes",
                 "a file that can be read", "check its permissions"});
  return text;
}

void write_new_text_file(const std::filesystem::path& file, const std::string& text,
                         const std::string& kind) {
  if (std::filesystem::exists(std::filesystem::symlink_status(file)))
    throw Error(Fault::kInput, {"the " + kind + " exists already", file.string(), "a file of that name",
                                "a new name", "choose another name, or remove it"});
  write_file(file, text);
}

}  // namespace arris
