// Many scans in one command: nothing that happens to one of them, or to the batch, loses the others.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "tests/end_to_end/job.hpp"

namespace arris {
namespace {

using testing::Job;
using testing::Ran;
using testing::text_of;

const std::string kProgram = "'" ARRIS_BINARY_DIR "/cli/arris'";

/// The example with some scans of it: s1.ply .. are good, bad.ply ends early.
class Batch : public ::testing::Test {
 protected:
  explicit Batch(int good = 2) {
    const std::string scan = text_of(std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures/example/scan.ply");
    for (int i = 1; i <= good; ++i) job.put("scans/s" + std::to_string(i) + ".ply", scan);
    job.put("scans/bad.ply", scan.substr(0, scan.size() / 2));
  }

  [[nodiscard]] Ran batch(const std::string& out, const std::string& more = "") const {
    return job.arris("batch recipe.toml scans --out " + out + " " + more);
  }
  [[nodiscard]] std::string summary(const std::string& out) const {
    return text_of(job.file(out + "/summary.csv"));
  }
  /// How often a word stands in times.csv as what was done now.
  [[nodiscard]] std::size_t count_now(const std::string& out, const std::string& word) const {
    std::istringstream text(text_of(job.file(out + "/times.csv")));
    std::size_t count = 0;
    for (std::string line; std::getline(text, line);)
      count += line.find("," + word + ",") != std::string::npos;
    return count;
  }
  /// Nothing half-written: no hidden name but the lock.
  void expect_whole(const std::string& out) const {
    if (!std::filesystem::exists(job.file(out))) return;
    for (const std::string& name : job.names(out))
      EXPECT_TRUE(!name.starts_with(".") || name == ".arris-batch") << name;
  }

  Job job{"example"};
};

TEST_F(Batch, OneBadScanNeverEndsTheRest) {
  const Ran ran = batch("out", "scans/missing.ply");
  EXPECT_EQ(ran.code, 3) << ran.out << ran.err;
  EXPECT_TRUE(ran.err.empty()) << "quiet in a pipe: " << ran.err;
  EXPECT_EQ(job.names("out"),
            (std::set<std::string>{".arris-batch", "s1", "s2", "summary.csv", "times.csv"}));
  std::istringstream text(summary("out"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_TRUE(lines[1].starts_with("scans/bad.ply,,3,wrong input,")) << lines[1];
  EXPECT_TRUE(lines[2].starts_with("scans/s1.ply,s1,0,good,ACCEPTED,PASS,")) << lines[2];
  EXPECT_TRUE(lines[4].starts_with("scans/missing.ply,,3,wrong input,")) << lines[4];
}

TEST_F(Batch, RunsAreThoseOfTheMainJobWithAnyNumberOfProcesses) {
  (void)batch("one", "--jobs 1");
  (void)batch("four", "--jobs 4 --threads 2");
  EXPECT_FALSE(summary("one").empty());
  EXPECT_EQ(summary("one"), summary("four"));
  ASSERT_EQ(job.run("scans/s1.ply", "alone").code, 0);
  EXPECT_EQ(job.names("one/s1"), job.names("alone"));
  for (const std::string& name : job.names("alone"))
    if (name != "run.json" && name != "log.jsonl") {
      EXPECT_EQ(text_of(job.file("one/s1/" + name)), text_of(job.file("alone/" + name))) << name;
    }
}

TEST_F(Batch, KeepsWhatIsCompleteAndRunsAgainWhatChanged) {
  (void)batch("out");
  const std::string first = summary("out");
  const std::string stamp = text_of(job.file("out/s1/run.json"));
  (void)batch("out");
  EXPECT_EQ(count_now("out", "kept"), 2U);
  EXPECT_EQ(summary("out"), first);
  EXPECT_EQ(text_of(job.file("out/s1/run.json")), stamp) << "it ran again";

  std::filesystem::remove(job.file("out/s1/report.html"));
  (void)batch("out");
  EXPECT_EQ(count_now("out", "kept"), 1U) << "a folder that lacks a file is not complete";
  EXPECT_TRUE(std::filesystem::exists(job.file("out/s1/report.html")));

  job.put("scans/s2.ply", text_of(job.file("scans/s2.ply")) + "\n");
  const Ran scan_changed = batch("out");
  EXPECT_NE(scan_changed.out.find("1 scan run again: the scan changed"), std::string::npos)
      << scan_changed.out;

  job.replace("recipe.toml", "contour_profile_mm = 1.5", "contour_profile_mm = 0.01");
  const Ran recipe_changed = batch("out", "--json");
  EXPECT_NE(summary("out"), first);
  const auto json = nlohmann::json::parse(recipe_changed.out);
  for (const auto& row : json.at("scans"))
    if (row.at("exit_code") != 3) {
      EXPECT_EQ(row.at("because"), "the recipe changed");
    }
  EXPECT_EQ(json.at("exit_code"), recipe_changed.code);
}

TEST_F(Batch, ForceRunsAllAgain) {
  (void)batch("out");
  const std::string first = summary("out");
  (void)batch("out", "--force");
  EXPECT_EQ(count_now("out", "run again"), 2U);
  EXPECT_EQ(summary("out"), first);
}

TEST_F(Batch, AFailedRunLeavesNoResultOfOtherInputs) {
  (void)batch("out");
  ASSERT_TRUE(job.names("out").contains("s1"));
  job.put("scans/s1.ply", text_of(job.file("scans/bad.ply")));
  (void)batch("out");
  EXPECT_FALSE(job.names("out").contains("s1"));
}

TEST_F(Batch, InspectsWithoutAPath) {
  std::filesystem::remove(job.file("path.csv"));
  const Ran ran = batch("out", "--inspect");
  EXPECT_EQ(ran.code, 3) << ran.err;
  EXPECT_FALSE(job.names("out/s1").contains("corrected.csv"));
  EXPECT_NE(summary("out").find("s1,0,good,NOT ASKED FOR,PASS,"), std::string::npos) << summary("out");
}

TEST_F(Batch, WhatIsWrongForAllIsToldOnceAndLeavesNothing) {
  job.replace("recipe.toml", "\"path.csv\"", "\"none.csv\"");
  const Ran ran = batch("out");
  EXPECT_EQ(ran.code, 3);
  EXPECT_NE(ran.err.find("none.csv"), std::string::npos) << ran.err;
  EXPECT_FALSE(job.names().contains("out"));
}

TEST_F(Batch, TakesNoFolderOfOthers) {
  job.put("mine/work.txt", "mine");
  const Ran ran = batch("mine");
  EXPECT_EQ(ran.code, 3);
  EXPECT_NE(ran.err.find("no batch folder"), std::string::npos) << ran.err;
  EXPECT_EQ(job.names("mine"), std::set<std::string>{"work.txt"});
}

TEST_F(Batch, OneAtATimeInAFolderAndDeadOnesDoNotCount) {
  std::filesystem::create_directory(job.file("out"));
  job.put("out/.arris-batch", "999999999");  // of a process that is long dead
  const int fd = ::open(job.file("out/.arris-batch").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(fd, LOCK_EX), 0);
  const Ran refused = batch("out");
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("in use"), std::string::npos) << refused.err;
  EXPECT_FALSE(job.names("out").contains("summary.csv"));
  ::close(fd);
  EXPECT_EQ(batch("out").code, 3);
  EXPECT_TRUE(job.names("out").contains("summary.csv"));
}

TEST_F(Batch, ACrashIsNamedWithItsSignalAndCountsAsOne) {
  // A file over the limit ends the process with SIGXFSZ (25) in the middle of its work.
  const Ran ran = job.arris("--version >version.txt; ulimit -f 64; exec " + kProgram +
                            " batch recipe.toml scans --out out");
  EXPECT_EQ(ran.code, 1) << ran.out << ran.err;
  EXPECT_NE(summary("out").find("scans/s1.ply,,1,crashed,"), std::string::npos) << summary("out");
  EXPECT_NE(summary("out").find("signal 25"), std::string::npos) << summary("out");
  expect_whole("out");
  (void)batch("out");
  EXPECT_NE(summary("out").find("scans/s1.ply,s1,0,good,"), std::string::npos) << summary("out");
}

TEST_F(Batch, AFullDiskIsNamedAndTheBatchGoesOnLater) {
  const std::string in_small_disk =
      "--version >version.txt; mkdir small; unshare -rm sh -c 'mount -t tmpfs -o size=300k none small && ";
  if (job.arris(in_small_disk + "true'").code != 0) GTEST_SKIP() << "no file system of its own can be made";
  std::filesystem::remove(job.file("small"));
  const Ran ran = job.arris(in_small_disk + "\"" ARRIS_BINARY_DIR
                                            "/cli/arris\" batch recipe.toml scans --out small/out; e=$?; "
                                            "ls -A small/out >left.txt; exit $e'");
  EXPECT_EQ(ran.code, 3) << ran.out << ran.err;
  EXPECT_NE(ran.err.find("No space left on device"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("free space"), std::string::npos) << ran.err;
  EXPECT_EQ(text_of(job.file("left.txt")).find(".part-"), std::string::npos) << text_of(job.file("left.txt"));
}

/// Starts the batch and sends its process a signal after a while; the exit code (128 + signal when killed).
int stopped_after(const Job& job, double seconds, const std::string& signal) {
  return job
      .arris("--version >version.txt; " + kProgram + " batch recipe.toml scans --out out --jobs 2 & sleep " +
             std::to_string(seconds) + "; kill -" + signal + " $! 2>/dev/null; wait $!")
      .code;
}

TEST_F(Batch, CtrlCStopsItsRunsAndLeavesNothingHalfWritten) {
  (void)batch("undisturbed");
  int heard = 0;
  for (double seconds = 0.05; seconds < 3.0 && heard < 3; seconds *= 1.6) {
    const int code = stopped_after(job, seconds, heard % 2 == 0 ? "INT" : "TERM");
    heard += code == 130;
    expect_whole("out");
    if (code != 130) continue;
    EXPECT_FALSE(std::filesystem::exists(job.file("out/summary.csv")));
  }
  EXPECT_GT(heard, 0);
  (void)batch("out");
  EXPECT_EQ(summary("out"), summary("undisturbed"));
}

TEST_F(Batch, AScanThatHangsIsEndedByTheTimeLimitAndTriedAgain) {
  const Ran ran =
      job.arris("--version >version.txt; " + kProgram +
                " batch recipe.toml scans/s1.ply --out out --timeout 1 & "
                "until child=$(cat /proc/$!/task/$!/children) && [ -n \"$child\" ] || ! kill -0 $!; "
                "do :; done; kill -STOP $child; wait $!");  // it hears nothing any more
  EXPECT_EQ(ran.code, 1) << ran.out << ran.err;
  EXPECT_NE(summary("out").find("scans/s1.ply,,1,crashed,"), std::string::npos) << summary("out");
  EXPECT_NE(summary("out").find("\"stopped, for it ran longer than 1 s (--timeout)\""), std::string::npos)
      << summary("out");
  expect_whole("out");
  EXPECT_EQ(job.arris("batch recipe.toml scans/s1.ply --out out --timeout 600").code, 0);
  EXPECT_NE(summary("out").find("scans/s1.ply,s1,0,good,"), std::string::npos) << summary("out");
}

class SoakBatch : public Batch {
 protected:
  SoakBatch() : Batch(4) {}
};

TEST_F(SoakBatch, KilledAtAnyMomentAndResumedLosesNothing) {
  const char* soak = std::getenv("ARRIS_SOAK");
  const int rounds = soak != nullptr && std::string(soak) == "1" ? 40 : 2;
  (void)batch("undisturbed");
  std::mt19937 random(20);
  int killed = 0;
  for (int round = 0; round < rounds; ++round) {
    std::filesystem::remove_all(job.file("out"));
    for (int kill = 0; kill < 4; ++kill) {
      const double seconds = std::uniform_real_distribution<>(0.02, 1.5)(random);
      killed += stopped_after(job, seconds, "KILL") == 137;
    }
    const Ran last = batch("out");
    ASSERT_EQ(last.code, 3) << last.err;
    expect_whole("out");
    ASSERT_EQ(summary("out"), summary("undisturbed")) << "round " << round;
    for (const std::string scan : {"s1", "s2", "s3", "s4"})
      for (const char* name : {"result.json", "corrected.csv", "program.mod", "report.html", "deviation.ply"})
        ASSERT_EQ(text_of(job.file("out/" + scan + "/" + name)),
                  text_of(job.file("undisturbed/" + scan + "/" + name)));
  }
  EXPECT_GT(killed, rounds) << "the batch was too fast to be killed";
}

}  // namespace
}  // namespace arris
