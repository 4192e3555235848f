#include "acquisition/files/storage.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

namespace arris::files {
namespace {

const char* next_step(int code) {
  switch (code) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return "free space on the disk, or name another folder, and run again";
    case EACCES:
    case EPERM:
      return "change the folder's permissions, or name another folder";
    case EROFS:
      return "name a folder on a disk that can be written";
    case ENOENT:
    case ENOTDIR:
      return "make the folder first, or name one that exists";
    case EIO:
      return "check the disk";
    default:
      return "check the folder and the disk, and run again";
  }
}

}  // namespace

Error storage_error(const std::string& what, const std::filesystem::path& where, int code) {
  return {Fault::kInput,
          {what, where.string(), std::strerror(code), "a folder with room and permission to write",
           next_step(code)}};
}

std::filesystem::path plain_path(const std::filesystem::path& path) {
  std::filesystem::path plain = path.lexically_normal();
  if (!plain.has_filename() && plain.has_parent_path() && plain != plain.root_path())
    plain = plain.parent_path();
  return plain;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

std::string make_temporary(const std::filesystem::path& target,
                           const std::function<bool(const std::string&)>& make) {
  static std::atomic<unsigned> counter{0};
  // Names may be 255 bytes long, and the target's own may use them all.
  const std::string front = (folder_of(target) / ("." + target.filename().string().substr(0, 200))).string();
  std::string name;
  do {
    name = front + ".part-" + std::to_string(::getpid()) + "-" + std::to_string(counter++);
  } while (!make(name) && errno == EEXIST);
  return name;
}

void flush_to_disk(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) throw storage_error("a result cannot be opened to flush it", path, errno);
  const int failed = ::fsync(fd) == 0 ? 0 : errno;
  ::close(fd);
  // Some file systems cannot flush a folder; that is no reason to lose the result.
  if (failed != 0 && failed != EINVAL && failed != ENOTSUP)
    throw storage_error("a result cannot be flushed to the disk", path, failed);
}

}  // namespace arris::files
