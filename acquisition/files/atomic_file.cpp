#include "acquisition/files/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <streambuf>

#include "acquisition/files/storage.hpp"

namespace arris {
namespace {

using files::storage_error;

/// A stream buffer over a descriptor that remembers why a write failed.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(int fd) : fd_(fd) { setp(buffer_.data(), buffer_.data() + buffer_.size()); }
  [[nodiscard]] int failure() const { return failure_; }

  bool flush_all() {
    const bool done = write_all(pbase(), pptr() - pbase());
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return done;
  }

 protected:
  int_type overflow(int_type c) override {
    if (!flush_all()) return traits_type::eof();
    if (!traits_type::eq_int_type(c, traits_type::eof())) {
      *pptr() = traits_type::to_char_type(c);
      pbump(1);
    }
    return traits_type::not_eof(c);
  }

  std::streamsize xsputn(const char* data, std::streamsize count) override {
    if (count < epptr() - pptr()) return std::streambuf::xsputn(data, count);
    return flush_all() && write_all(data, count) ? count : 0;
  }

  int sync() override { return flush_all() ? 0 : -1; }

 private:
  bool write_all(const char* data, std::streamsize count) {
    while (count > 0 && failure_ == 0) {
      const ssize_t written = ::write(fd_, data, static_cast<std::size_t>(count));
      if (written > 0) {
        data += written;
        count -= written;
      } else if (written == 0 || errno != EINTR) {
        failure_ = written == 0 ? ENOSPC : errno;
      }
    }
    return failure_ == 0;
  }

  int fd_;
  int failure_ = 0;
  std::array<char, 65536> buffer_;
};

}  // namespace

class AtomicFile::Impl {
 public:
  explicit Impl(const std::filesystem::path& target) : target_(files::plain_path(target)) {
    if (std::filesystem::is_directory(target_))
      throw Error(Fault::kInput, {"the output file is a folder", target_.string(), "a folder",
                                  "the name of a file", "name a file inside that folder"});
    temporary_ = files::make_temporary(target_, [this](const std::string& name) {
      fd_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      return fd_ >= 0;
    });
    if (fd_ < 0) throw storage_error("the file cannot be written", target_, errno);
    buffer_ = std::make_unique<DescriptorBuffer>(fd_);
    stream_ = std::make_unique<std::ostream>(buffer_.get());
  }

  ~Impl() { abandon(); }

  std::ostream& stream() { return *stream_; }

  void commit() {
    if (fd_ < 0) throw Error(Fault::kBug, "an atomic file was committed twice");
    int failure = buffer_->flush_all() ? 0 : buffer_->failure();
    if (failure == 0 && stream_->fail()) failure = EIO;
    if (failure == 0 && ::fsync(fd_) != 0) failure = errno;
    if (::close(fd_) != 0 && failure == 0) failure = errno;
    fd_ = -1;
    if (failure == 0 && ::rename(temporary_.c_str(), target_.c_str()) != 0) failure = errno;
    if (failure != 0) {
      ::unlink(temporary_.c_str());
      throw storage_error("the file cannot be written", target_, failure);
    }
    files::flush_to_disk(files::folder_of(target_));
  }

 private:
  void abandon() {
    if (fd_ < 0) return;
    ::close(fd_);
    ::unlink(temporary_.c_str());
    fd_ = -1;
  }

  std::filesystem::path target_;
  std::string temporary_;
  int fd_ = -1;
  std::unique_ptr<DescriptorBuffer> buffer_;
  std::unique_ptr<std::ostream> stream_;
};

AtomicFile::AtomicFile(const std::filesystem::path& target) : impl_(std::make_unique<Impl>(target)) {}
AtomicFile::~AtomicFile() = default;
std::ostream& AtomicFile::stream() {
  return impl_->stream();
}
void AtomicFile::commit() {
  impl_->commit();
}

void write_file(const std::filesystem::path& target, std::string_view bytes) {
  AtomicFile file(target);
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

}  // namespace arris
