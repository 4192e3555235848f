#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "acquisition/files/atomic_file.hpp"
#include "acquisition/files/storage.hpp"

namespace arris {
namespace {

namespace fs = std::filesystem;
using files::storage_error;

/// Exchanges two names or refuses to overwrite, where the file system can; errno otherwise.
int rename_with(const fs::path& from, const fs::path& to, unsigned int flag) {
  return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flag) == 0 ? 0 : errno;
}

bool lacks_flag(int failure) {
  return failure == EINVAL || failure == ENOSYS || failure == ENOTSUP;
}

int rename_plainly(const fs::path& from, const fs::path& to) {
  return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

/// Whether the path names `folder` or a folder above it.
bool holds(const fs::path& path, const fs::path& folder) {
  const auto [end, ignored] = std::mismatch(path.begin(), path.end(), folder.begin(), folder.end());
  return end == path.end();
}

bool is_empty_folder(const fs::path& path) {
  std::error_code failed;
  return fs::is_directory(path, failed) && fs::is_empty(path, failed);
}

/// Flushes every file and folder below, then the folder itself.
void flush_tree(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_symlink()) continue;
    if (entry.is_directory())
      flush_tree(entry.path());
    else if (entry.is_regular_file())
      files::flush_to_disk(entry.path());
  }
  files::flush_to_disk(folder);
}

Error exists_already(const fs::path& target) {
  return {Fault::kInput,
          {"the output exists already", target.string(), "a file or folder of that name", "a new name",
           "name another output, or use --force to replace it"}};
}

}  // namespace

AtomicFolder::AtomicFolder(const fs::path& target, bool force, std::string mark)
    : target_(files::plain_path(target)), force_(force), mark_(std::move(mark)) {
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(target_, ignored))) {
    if (!force_) throw exists_already(target_);
    check_replaceable();
  }
  bool made = false;
  const std::string name = files::make_temporary(target_, [&made](const std::string& candidate) {
    made = ::mkdir(candidate.c_str(), 0777) == 0;
    return made;
  });
  if (!made) throw storage_error("the output folder cannot be made", target_, errno);
  temporary_ = name;
}

AtomicFolder::~AtomicFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

void AtomicFolder::check_replaceable() const {
  std::error_code failed;
  const auto refuse = [this](const std::string& found, const std::string& needed) {
    return Error(Fault::kInput,
                 {"the output may not be replaced", target_.string(), found, needed, "name another output"});
  };
  const fs::path real = fs::weakly_canonical(target_, failed);
  const char* const home = std::getenv("HOME");
  if (holds(real, fs::current_path(failed)))
    throw refuse("the current folder or one above it", "a folder of results");
  if (home != nullptr && *home != '\0' && holds(real, fs::weakly_canonical(home, failed)))
    throw refuse("the home folder or one above it", "a folder of results");
  const bool folder = fs::is_directory(fs::symlink_status(target_, failed));
  if (!mark_.empty() && !is_empty_folder(target_) && !(folder && fs::exists(target_ / mark_, failed)))
    throw refuse(folder ? std::string("a folder without ").append(mark_) : "no folder",
                 std::string("a folder that holds ").append(mark_).append(", or is empty"));
}

void AtomicFolder::commit() {
  if (temporary_.empty()) throw Error(Fault::kBug, "an atomic folder was committed twice");
  try {
    flush_tree(temporary_);
  } catch (const fs::filesystem_error& failed) {
    throw storage_error("the output folder cannot be flushed", target_, failed.code().value());
  }
  int failure = rename_with(temporary_, target_, RENAME_NOREPLACE);
  if (lacks_flag(failure)) {
    std::error_code ignored;
    failure = fs::exists(fs::symlink_status(target_, ignored)) ? EEXIST : rename_plainly(temporary_, target_);
  }
  if (failure == EEXIST && !force_) throw exists_already(target_);
  if (failure != 0 && failure != EEXIST)
    throw storage_error("the output folder cannot be named", target_, failure);
  if (failure == EEXIST)
    replace_target();
  else
    temporary_.clear();
  files::flush_to_disk(files::folder_of(target_));
}

/// The old folder ends under the temporary name, which the destructor removes.
void AtomicFolder::replace_target() {
  check_replaceable();
  int failure = rename_with(temporary_, target_, RENAME_EXCHANGE);
  if (lacks_flag(failure)) {
    const fs::path old = temporary_.string() + ".old";
    failure = rename_plainly(target_, old);
    if (failure == 0) {
      failure = rename_plainly(temporary_, target_);
      if (failure != 0) rename_plainly(old, target_);
      if (failure == 0) temporary_ = old;
    }
  }
  if (failure != 0) throw storage_error("the output folder cannot be replaced", target_, failure);
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
  temporary_.clear();
}

}  // namespace arris
