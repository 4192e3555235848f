#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace arris::files {

/// A regular file, mapped read-only for as long as the object lives.
///   throws   Error(kInput), one message each: missing, a folder, not a regular file, not readable, empty
/// The file must not be made shorter while it is mapped: wait until a scanner has closed its file before
/// reading it.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::string_view bytes() const { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace arris::files
