#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace arris {

/// The folder of a batch, held by this process alone as long as the object lives. The lock ends with the
/// processes that hold it (the batch and its children), so a killed batch leaves none behind.
class BatchFolder {
 public:
  /// Makes or takes the folder, and removes what killed processes left half-written in it.
  ///   throws  Error(kInput): another batch holds it, it holds other things than a batch, it cannot be
  ///   written
  explicit BatchFolder(const std::filesystem::path& folder);
  ~BatchFolder();
  BatchFolder(const BatchFolder&) = delete;
  BatchFolder& operator=(const BatchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  [[nodiscard]] std::filesystem::path run_folder(const std::string& name) const { return folder_ / name; }

  /// Removes what killed processes were writing of `name`; of all with "". Who holds the lock writes alone,
  /// so it belongs to the dead.
  void remove_leftovers(const std::string& name) const;

  /// Names in the folder that are not run folders.
  [[nodiscard]] static std::vector<std::string> reserved_names();

 private:
  void check_is_ours() const;
  void lock();

  std::filesystem::path folder_;
  int lock_fd_ = -1;
};

inline constexpr const char* kSummaryName = "summary.csv";
inline constexpr const char* kTimesName = "times.csv";

}  // namespace arris
