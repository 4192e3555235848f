#pragma once

#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>

namespace arris {

/// A file that appears whole or not at all: written under a hidden name beside its target, flushed to the
/// disk (file and folder), then renamed onto it. An existing file is replaced in one step.
///   throws   Error(kInput): folder missing or not writable, disk full, any write or flush that fails; the
///   temporary
///            file is gone then
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();  ///< without commit(): removes what was written
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write; a failed write shows at commit().
  [[nodiscard]] std::ostream& stream();

  void commit();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// All of a file in one go, as AtomicFile.
void write_file(const std::filesystem::path& target, std::string_view bytes);

/// A folder that appears whole or not at all: filled under a hidden name beside its target, every file in it
/// flushed, then renamed.
///   target   an existing file or folder of that name is Error(kInput) unless force
///   force    commit() puts the new folder in the place of the old in one step where the file system can swap
///   two
///            names, else in two renames, and then deletes the old. Never replaced: the current folder, a
///            folder above it, the home folder
///   mark     with force: the old folder is replaced only when it is empty or holds an entry of this name, so
///   that
///            a mistyped target costs nobody's work; empty: any folder
class AtomicFolder {
 public:
  explicit AtomicFolder(const std::filesystem::path& target, bool force = false, std::string mark = {});
  ~AtomicFolder();  ///< without commit(): removes the temporary folder and all in it
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// The temporary folder: write into it.
  [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }
  /// Where it will be.
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }

  /// Throws Error(kInput) as AtomicFile, and when another process has made the target meanwhile (unless
  /// force).
  void commit();

 private:
  void check_replaceable() const;
  void replace_target();

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool force_;
  std::string mark_;
};

}  // namespace arris
