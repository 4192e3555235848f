#include "acquisition/files/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "acquisition/types/error.hpp"

namespace arris::files {
namespace {

Error open_error(const std::string& name, int code) {
  if (code == ENOENT || code == ENOTDIR)
    return {
        Fault::kInput,
        {"the file does not exist", name, "nothing of that name", "a file", "check the name and the folder"}};
  if (code == EACCES || code == EPERM)
    return {
        Fault::kInput,
        {"the file may not be read", name, "no permission", "read permission", "change its owner or mode"}};
  return {
      Fault::kInput,
      {"the file cannot be opened", name, std::strerror(code), "a readable file", "check the disk and name"}};
}

/// Closes the descriptor on every way out.
struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

std::size_t checked_size(const std::string& name, int fd) {
  struct stat info {};
  if (::fstat(fd, &info) != 0) throw open_error(name, errno);
  if (S_ISDIR(info.st_mode))
    throw Error(Fault::kInput,
                {"the path is a folder", name, "a folder", "a file", "name one file inside the folder"});
  if (!S_ISREG(info.st_mode))
    throw Error(Fault::kInput, {"the path is not a regular file", name, "a device, pipe or socket",
                                "a regular file", "copy the data into a file first"});
  if (info.st_size == 0)
    throw Error(Fault::kInput,
                {"the file is empty", name, "0 bytes", "a scan or mesh", "export or copy the file again"});
  return static_cast<std::size_t>(info.st_size);
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& file) {
  const std::string name = file.string();
  // Non-blocking, so that a pipe is refused instead of waited for.
  const Descriptor descriptor{::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (descriptor.fd < 0) throw open_error(name, errno);
  size_ = checked_size(name, descriptor.fd);
  void* mapped = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor.fd, 0);
  if (mapped == MAP_FAILED) throw open_error(name, errno);
  ::madvise(mapped, size_, MADV_WILLNEED);
  data_ = static_cast<const char*>(mapped);
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(const_cast<char*>(data_), size_);
}

}  // namespace arris::files
