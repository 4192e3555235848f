#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

#include "acquisition/files/load_file.hpp"
#include "acquisition/types/error.hpp"

namespace arris::testing {

/// Bytes of a file, put together by the test itself.
class Bytes {
 public:
  Bytes& text(std::string_view part) {
    bytes_ += part;
    return *this;
  }
  template <class T>
  Bytes& little(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof value);
    bytes_.append(raw, sizeof value);
    return *this;
  }
  template <class T>
  Bytes& big(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof value);
    std::reverse(raw, raw + sizeof value);
    bytes_.append(raw, sizeof value);
    return *this;
  }
  [[nodiscard]] const std::string& str() const { return bytes_; }

 private:
  std::string bytes_;
};

/// A folder of the test's own, removed at its end.
class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "arris-files-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw Error(Fault::kBug, "no temporary folder");
    path_ = name;
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Reads bytes as the file of that name would be read.
inline files::Loaded load(std::string_view bytes, const std::string& name = "scan", bool wide = false) {
  return files::load_bytes(files::Source{bytes, name, 1.0, wide});
}

/// The message of the Error(kInput) that the call throws; a failure when it throws none.
inline std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kInput) << error.what();
    const std::string line = error.what();
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    for (const char* part : {": found ", "; needed ", "; next: "})
      EXPECT_NE(line.find(part), std::string::npos) << line;
    return line;
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

inline std::string error_of_bytes(std::string_view bytes, const std::string& name = "scan") {
  return error_of([&] { static_cast<void>(load(bytes, name)); });
}

/// What a message must say, and where.
inline ::testing::AssertionResult says(const std::string& line, const std::string& part) {
  if (line.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "'" << part << "' is not in: " << line;
}

/// Point i in file coordinates.
inline Eigen::Vector3d point_of(const files::Loaded& loaded, std::size_t i) {
  if (!loaded.wide_mm.empty()) return loaded.wide_mm.at(i);
  return loaded.near_mm.at(i).cast<double>() + loaded.offset_mm;
}

}  // namespace arris::testing
