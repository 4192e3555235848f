#include "cli/batch_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "acquisition/files/storage.hpp"
#include "acquisition/types/error.hpp"

namespace arris {
namespace {

namespace fs = std::filesystem;
using files::storage_error;

constexpr const char* kLockName = ".arris-batch";  // also the mark of a batch folder
constexpr int kLockTries = 20;  // the children of a killed batch hold its lock until they are dead
constexpr std::chrono::milliseconds kLockPause{100};

std::string holder_in(int fd) {
  char text[64] = {};
  const ssize_t count = ::pread(fd, text, sizeof text - 1, 0);
  const std::string pid(text, count > 0 ? static_cast<std::size_t>(count) : 0);
  return pid.empty() ? "another batch" : "a batch that is running (process " + pid + ")";
}

}  // namespace

std::vector<std::string> BatchFolder::reserved_names() {
  return {kSummaryName, kTimesName, kLockName};
}

BatchFolder::BatchFolder(const fs::path& folder) : folder_(files::plain_path(folder)) {
  std::error_code failed;
  fs::create_directories(folder_, failed);
  if (failed) throw storage_error("the batch folder cannot be made", folder_, failed.value());
  check_is_ours();
  lock();
  remove_leftovers("");
}

BatchFolder::~BatchFolder() {
  (void)!::ftruncate(lock_fd_, 0);
  ::close(lock_fd_);
}

void BatchFolder::check_is_ours() const {
  std::error_code failed;
  if (fs::exists(folder_ / kLockName, failed) || fs::is_empty(folder_, failed)) return;
  throw Error(Fault::kInput,
              {"the folder is no batch folder", folder_.string(), "other files in it",
               "a new folder, an empty one, or that of an earlier batch", "name another one with --out"});
}

/// The lock is inherited by the children on purpose: it is free when the last one is dead.
void BatchFolder::lock() {
  const fs::path file = folder_ / kLockName;
  lock_fd_ = ::open(file.c_str(), O_RDWR | O_CREAT, 0666);  // NOLINT(android-cloexec-open)
  if (lock_fd_ < 0) throw storage_error("the batch folder cannot be written", folder_, errno);
  int failure = EWOULDBLOCK;
  for (int left = kLockTries; failure == EWOULDBLOCK && left > 0; --left) {
    failure = ::flock(lock_fd_, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    if (failure == EWOULDBLOCK) std::this_thread::sleep_for(kLockPause);
  }
  if (failure != 0) {
    const std::string holder = holder_in(lock_fd_);
    ::close(lock_fd_);
    if (failure != EWOULDBLOCK) throw storage_error("the batch folder cannot be locked", folder_, failure);
    throw Error(Fault::kInput, {"the batch folder is in use", folder_.string(), holder, "one batch a folder",
                                "wait until it ends, or name another folder with --out"});
  }
  const std::string pid = std::to_string(::getpid());
  (void)!::ftruncate(lock_fd_, 0);
  (void)!::pwrite(lock_fd_, pid.data(), pid.size(), 0);
}

void BatchFolder::remove_leftovers(const std::string& name) const {
  const auto is_half_written = [&](const std::string& found) {  // as AtomicFile and AtomicFolder name it
    return found.starts_with("." + name) && found.find(".part-") != std::string::npos;
  };
  std::error_code failed;
  std::vector<fs::path> left;
  for (fs::directory_iterator it(folder_, failed), end; !failed && it != end; it.increment(failed))
    if (is_half_written(it->path().filename().string())) left.push_back(it->path());
  for (const fs::path& path : left) fs::remove_all(path, failed);
}

}  // namespace arris
