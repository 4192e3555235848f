#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

#include "acquisition/files/atomic_file.hpp"
#include "acquisition/files/sha256.hpp"
#include "tests/acquisition/files/file_bytes.hpp"

namespace arris::testing {
namespace {

namespace fs = std::filesystem;

std::size_t entries_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// No file may grow beyond `bytes` while this lives: what a full disk does to write().
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST(AtomicFile, AppearsAtCommitWithAllItsBytes) {
  const TempFolder folder;
  const fs::path target = folder.path() / "a.txt";
  std::string truth;
  {
    AtomicFile file(target);
    for (int i = 0; i < 100000; ++i) {
      file.stream() << i << '\n';
      truth += std::to_string(i) + '\n';
    }
    file.stream().write(truth.data(), static_cast<std::streamsize>(truth.size()));
    EXPECT_FALSE(fs::exists(target));
    file.commit();
  }
  EXPECT_EQ(content_of(target), truth + truth);
  EXPECT_EQ(entries_in(folder.path()), 1U);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  struct stat info {};
  ASSERT_EQ(::stat(target.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777U, 0666U & ~mask);
}

TEST(AtomicFile, ReplacesAnOldFileOrLeavesItAlone) {
  const TempFolder folder;
  const fs::path target = folder.write("a.txt", "old");
  {
    AtomicFile file(target);
    file.stream() << "half";
  }
  EXPECT_EQ(content_of(target), "old");
  EXPECT_EQ(entries_in(folder.path()), 1U);
  write_file(target, "new");
  EXPECT_EQ(content_of(target), "new");
}

TEST(AtomicFile, FullDiskLeavesNothingBehind) {
  const TempFolder folder;
  const fs::path target = folder.write("a.txt", "old");
  const FullDisk full(100000);
  for (const std::size_t size : {100001UL, 300000UL}) {
    const std::string line = error_of([&] { write_file(target, std::string(size, 'x')); });
    EXPECT_TRUE(says(line, "the file cannot be written"));
    EXPECT_TRUE(says(line, "next: free space on the disk"));
    AtomicFile many(target);
    for (std::size_t i = 0; i < size; ++i) many.stream().put('x');
    EXPECT_TRUE(says(error_of([&] { many.commit(); }), "the file cannot be written"));
  }
  EXPECT_EQ(content_of(target), "old");
  EXPECT_EQ(entries_in(folder.path()), 1U);
}

TEST(AtomicFile, SaysWhatIsWrongWithTheTarget) {
  const TempFolder folder;
  EXPECT_TRUE(says(error_of([&] { write_file(folder.path() / "none" / "a.txt", "x"); }),
                   "next: make the folder first"));
  EXPECT_TRUE(says(error_of([&] { write_file(folder.path(), "x"); }), "the output file is a folder"));
  const auto file = folder.write("file", "x");
  EXPECT_TRUE(says(error_of([&] { write_file(file / "a.txt", "x"); }), "the file cannot be written"));
}

TEST(AtomicFile, LongestName) {
  const TempFolder folder;
  write_file(folder.path() / std::string(255, 'n'), "x");
  EXPECT_EQ(entries_in(folder.path()), 1U);
}

TEST(AtomicFile, CannotBeCommittedTwice) {
  const TempFolder folder;
  AtomicFile file(folder.path() / "a");
  file.commit();
  EXPECT_THROW(file.commit(), Error);
}

void fill(const AtomicFolder& folder, const std::string& text) {
  fs::create_directories(folder.path() / "sub");
  std::ofstream(folder.path() / "result.json") << text;
  std::ofstream(folder.path() / "sub" / "more") << text;
}

TEST(AtomicFolder, AppearsAtCommitOrNever) {
  const TempFolder folder;
  const fs::path target = folder.path() / "run/";
  {
    AtomicFolder abandoned(target);
    fill(abandoned, "x");
  }
  EXPECT_EQ(entries_in(folder.path()), 0U);
  AtomicFolder run(target);
  EXPECT_EQ(run.target(), folder.path() / "run");
  fill(run, "x");
  EXPECT_FALSE(fs::exists(target));
  run.commit();
  EXPECT_EQ(content_of(target / "sub" / "more"), "x");
  EXPECT_EQ(entries_in(folder.path()), 1U);
  EXPECT_THROW(run.commit(), Error);
}

TEST(AtomicFolder, ExistingTargetNeedsForce) {
  const TempFolder folder;
  const fs::path target = folder.path() / "run";
  AtomicFolder first(target);
  fill(first, "old");
  first.commit();
  EXPECT_TRUE(says(error_of([&] { AtomicFolder again(target); }), "the output exists already"));
  {
    AtomicFolder abandoned(target, true);
    fill(abandoned, "half");
  }
  EXPECT_EQ(content_of(target / "result.json"), "old");
  AtomicFolder second(target, true, "result.json");
  std::ofstream(second.path() / "result.json") << "new";
  second.commit();
  EXPECT_EQ(content_of(target / "result.json"), "new");
  EXPECT_FALSE(fs::exists(target / "sub"));
  EXPECT_EQ(entries_in(folder.path()), 1U);
}

TEST(AtomicFolder, TargetMadeMeanwhileIsNotOverwritten) {
  const TempFolder folder;
  const fs::path target = folder.path() / "run";
  AtomicFolder run(target);
  fs::create_directory(target);
  EXPECT_TRUE(says(error_of([&] { run.commit(); }), "the output exists already"));
}

TEST(AtomicFolder, ForceNeverReplacesWhatIsNoResult) {
  const TempFolder folder;
  fs::create_directory(folder.path() / "photos");
  std::ofstream(folder.path() / "photos" / "cat.jpg") << "x";
  const auto refused = [&](const fs::path& target, const std::string& mark) {
    return error_of([&] { AtomicFolder run(target, true, mark); });
  };
  EXPECT_TRUE(says(refused(folder.path() / "photos", "result.json"), "found a folder without result.json"));
  EXPECT_TRUE(says(refused(folder.path() / "photos" / "cat.jpg", "result.json"), "found no folder"));
  EXPECT_TRUE(says(refused(".", ""), "found the current folder or one above it"));
  EXPECT_TRUE(says(refused("/", ""), "the output may not be replaced"));
  fs::create_directory(folder.path() / "empty");
  AtomicFolder(folder.path() / "empty", true, "result.json").commit();
  AtomicFolder(folder.path() / "photos", true).commit();
  EXPECT_EQ(entries_in(folder.path() / "photos"), 0U);
}

TEST(AtomicFolder, SaysWhenItCannotBeMade) {
  const TempFolder folder;
  EXPECT_TRUE(says(error_of([&] { AtomicFolder run(folder.path() / "none" / "run"); }),
                   "the output folder cannot be made"));
}

TEST(Sha256, KnownAnswers) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, OfFiles) {
  const TempFolder folder;
  EXPECT_EQ(sha256_file(folder.write("a", "abc")), sha256_hex("abc"));
  EXPECT_EQ(sha256_file(folder.write("b", "")), sha256_hex(""));
  EXPECT_TRUE(says(error_of([&] { static_cast<void>(sha256_file(folder.path() / "none")); }),
                   "the file does not exist"));
}

}  // namespace
}  // namespace arris::testing
