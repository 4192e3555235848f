// What a batch decides without running anything: which scans, their names, the worst code, the table.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <random>

#include "acquisition/types/error.hpp"
#include "cli/batch_rows.hpp"
#include "cli/batch_scans.hpp"
#include "cli/batch_summary.hpp"
#include "tests/cli/run_arris.hpp"

namespace arris {
namespace {

using Paths = std::vector<std::filesystem::path>;
using Names = std::vector<std::string>;

Names files_of(const std::vector<BatchScan>& scans) {
  Names files;
  for (const BatchScan& scan : scans) files.push_back(scan.file.filename().string());
  return files;
}

TEST(BatchNames, AreStemsUntilTheyClash) {
  EXPECT_EQ(run_names({"/a/p7.ply", "/a/p8.ply"}, {}), (Names{"p7", "p8"}));
  EXPECT_EQ(run_names({"/a/p7.ply", "/a/p7.stl", "/a/p8.ply"}, {}), (Names{"p7.ply", "p7.stl", "p8"}));
  EXPECT_EQ(run_names({"/s/mon/p7.ply", "/s/tue/p7.ply", "/s/p8.ply"}, {}),
            (Names{"mon_p7.ply", "tue_p7.ply", "p8"}));
  EXPECT_EQ(run_names({"/a/summary.csv.ply"}, {"summary.csv"}), (Names{"summary.csv.ply"}));
}

TEST(BatchNames, AreUniqueAndDoNotDependOnTheOrder) {
  Paths files;
  for (const char* folder : {"/x/a", "/x/b", "/x/a/b", "/y/a", "/"})
    for (const char* name : {"p1.ply", "p1.stl", "p2.ply", "p1"})
      files.push_back(std::filesystem::path(folder) / name);
  std::map<std::filesystem::path, std::string> first;
  std::mt19937 random(7);
  for (int time = 0; time < 20; ++time) {
    const Names names = run_names(files, {"p2.ply"});
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), files.size());
    for (std::size_t i = 0; i < files.size(); ++i)
      EXPECT_EQ(first.emplace(files[i], names[i]).first->second, names[i]) << files[i];
    std::shuffle(files.begin(), files.end(), random);
  }
}

TEST(BatchNames, OfPathsThatReadAlikeGetANumber) {
  const Names names = run_names({"/a/b_c/p.ply", "/a_b/c/p.ply", "/a/b/c/p.ply"}, {});
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), 3U);
}

TEST(BatchScans, FoldersGiveTheirScansByNameAndNotTheDrawing) {
  const testing::TestFolder folder;
  for (const char* name : {"b.ply", "a.PCD", "cad.stl", ".hidden.ply", "notes.md", "deeper/c.ply"})
    folder.write(name, "x");
  EXPECT_EQ(files_of(batch_scans({folder.path().string()}, {folder.path() / "cad.stl"})),
            (Names{"a.PCD", "b.ply"}));
  folder.write("empty/readme.md", "x");
  EXPECT_THROW((void)batch_scans({(folder.path() / "empty").string()}, {}), Error);
}

TEST(BatchScans, ListsHoldAPathALine) {
  const testing::TestFolder folder;
  const auto list = folder.write("list.txt", "# of May\n\n  one.ply\r\nwith blank.ply\ntwo.ply");
  EXPECT_EQ(files_of(batch_scans({"zero.ply", "@" + list.string(), "./one.ply"}, {})),
            (Names{"zero.ply", "one.ply", "with blank.ply", "two.ply"}))
      << "in their order, each file once";
  const auto empty = folder.write("empty.txt", "# nothing\n");
  EXPECT_THROW((void)batch_scans({"@" + empty.string()}, {}), Error);
  EXPECT_THROW((void)batch_scans({"@none.txt"}, {}), Error);
}

BatchRow row_with(int exit_code) {
  BatchRow row;
  row.exit_code = exit_code;
  return row;
}

TEST(BatchOutcome, IsTheWorstOfItsParts) {
  const std::vector<int> order{1, 6, 3, 5, 4, 7, 0};
  for (unsigned subset = 1; subset < 128; ++subset) {
    std::vector<BatchRow> rows;
    int worst = -1;
    for (std::size_t i = 0; i < order.size(); ++i)
      if ((subset >> i) & 1U) {
        rows.insert(rows.begin(), row_with(order[i]));
        if (worst < 0) worst = order[i];
      }
    EXPECT_EQ(worst_exit_code(rows), worst);
    EXPECT_EQ(outcome_counts(rows).size(), rows.size());
  }
}

TEST(BatchOutcome, OfAProcessThatDidNotEndByItselfIsOne) {
  ChildEnd killed;
  killed.signal = 11;
  EXPECT_EQ(row_of_failure({"a.ply", "a"}, killed).exit_code, 1);
  EXPECT_NE(row_of_failure({"a.ply", "a"}, killed).message.find("signal 11"), std::string::npos);
  ChildEnd stopped;
  stopped.exit_code = 130;
  EXPECT_EQ(row_of_failure({"a.ply", "a"}, stopped).exit_code, 1);
  ChildEnd refused;
  refused.exit_code = 3;
  refused.said = "arris: note: x\narris: the file is empty\n";
  EXPECT_EQ(row_of_failure({"a.ply", "a"}, refused).exit_code, 3);
  EXPECT_EQ(row_of_failure({"a.ply", "a"}, refused).message, "the file is empty");
}

std::vector<ChildEnd> ended(ChildPool& pool) {
  std::vector<ChildEnd> all;
  while (pool.running() > 0)
    for (ChildEnd& end : pool.wait(-1)) all.push_back(std::move(end));
  return all;
}

// The children are this test program: it hangs when its file of flags is a pipe that nobody writes.
TEST(ChildPool, KillsWhatRunsLongerThanItMay) {
  const testing::TestFolder folder;
  const std::string pipe = (folder.path() / "flags").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ChildPool pool(0.3);
  pool.start(7, {"--gtest_flagfile=" + pipe});
  const std::vector<ChildEnd> ends = ended(pool);
  ASSERT_EQ(ends.size(), 1U);
  EXPECT_EQ(ends[0].id, 7);
  EXPECT_EQ(ends[0].signal, SIGKILL);
  EXPECT_EQ(ends[0].late_s, 0.3);
  EXPECT_GE(ends[0].wall_s, 0.3);
}

TEST(ChildPool, LeavesThoseAloneThatEndInTime) {
  for (const double most_s : {0.0, 3600.0}) {
    ChildPool pool(most_s);
    pool.start(1, {"--gtest_list_tests"});
    pool.start(2, {"--gtest_list_tests"});
    const std::vector<ChildEnd> ends = ended(pool);
    EXPECT_EQ(ends.size(), 2U);
    for (const ChildEnd& end : ends) {
      EXPECT_EQ(end.exit_code, 0) << end.said;
      EXPECT_EQ(end.late_s, 0.0);
    }
  }
}

TEST(BatchRows, OfAScanThatRanTooLongNamesTheLimit) {
  ChildEnd late;
  late.signal = SIGKILL;
  late.late_s = 60.0;
  const BatchRow row = row_of_failure({"a.ply", "a"}, late);
  EXPECT_EQ(row.exit_code, 1);
  EXPECT_EQ(row.message, "stopped, for it ran longer than 60 s (--timeout)");
}

TEST(BatchProgressLine, SaysHowManyAreNotGoodAndHowLongItTakes) {
  EXPECT_EQ(progress_text({.done = 0, .total = 1, .not_good = 0, .left_s = {}, .running = {"a"}}),
            "0/1 scan; running a");
  EXPECT_EQ(progress_text({.done = 12, .total = 1000, .not_good = 1, .left_s = 200.0, .running = {"a", "b"}}),
            "12/1000 scans, 1 not good, 3 min left; running a, b");
  EXPECT_EQ(progress_text({.done = 5, .total = 5, .not_good = 5, .left_s = 0.0, .running = {}}),
            "5/5 scans, 5 not good");
}

TEST(BatchInputs, AnyDifferenceIsNamed) {
  RunResult stored;
  stored.version = "arris 1";
  stored.inputs = {{"scan", "s.ply", "aa"}, {"cad", "c.stl", "bb"}, {"recipe", "r.toml", "cc"}};
  EXPECT_EQ(difference(stored, stored.inputs, "arris 1"), "");
  EXPECT_EQ(difference(stored, stored.inputs, "arris 2"), "it was made by arris 1");
  for (std::size_t i = 0; i < stored.inputs.size(); ++i) {
    std::vector<InputFile> now = stored.inputs;
    now[i].sha256 = "dd";
    EXPECT_EQ(difference(stored, now, "arris 1"), "the " + now[i].role + " changed");
    now.erase(now.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_EQ(difference(stored, now, "arris 1"), "it was made with a " + stored.inputs[i].role);
  }
  std::vector<InputFile> more = stored.inputs;
  more.push_back({"cell", "cell.toml", "ee"});
  EXPECT_EQ(difference(stored, more, "arris 1"), "it was made without the cell");
}

TEST(BatchSummary, QuotesAsRfc4180Says) {
  BatchRow row = row_with(3);
  row.scan = {"a,\"b\".ply", "x"};
  row.message = "line one\nline two";
  const std::string csv = summary_csv(std::vector<BatchRow>{row});
  EXPECT_NE(csv.find("\n\"a,\"\"b\"\".ply\",,3,wrong input,"), std::string::npos) << csv;
  EXPECT_TRUE(csv.ends_with(",\"line one\nline two\"\n")) << csv;
}

TEST(BatchSummary, DoesNotDependOnWhenOrHowOften) {
  BatchRow first = row_with(5), again = row_with(5);
  again.kept = true;
  again.wall_s = 3.0;
  again.run_again_because = "the recipe changed";
  EXPECT_EQ(summary_csv(std::vector<BatchRow>{first}), summary_csv(std::vector<BatchRow>{again}));
  EXPECT_NE(times_csv(std::vector<BatchRow>{first}), times_csv(std::vector<BatchRow>{again}));
}

}  // namespace
}  // namespace arris
