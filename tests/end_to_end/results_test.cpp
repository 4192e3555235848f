// What a run folder promises: one result_hash everywhere, the same bytes every time, nothing handed out when
// the run is refused.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "fixtures/synthetic/write.hpp"
#include "tests/end_to_end/job.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;
using nlohmann::json;
using testing::Job;
using testing::Ran;
using testing::Table;
using testing::text_of;

/// Float about any sensible offset holds points on this grid exactly, so the shift alone is tested.
constexpr double kFloatGridMm = 1.0 / 1024.0;

bool processed(const Ran& ran) {
  return ran.code == 0 || ran.code == 4 || ran.code == 7;
}

std::string hash_in(const Job& job, const std::string& out) {
  return json::parse(text_of(job.file(out + "/result.json"))).at("result_hash").get<std::string>();
}

/// Bytes of every result file; run.json and log.jsonl hold times and are left out.
std::map<std::string, std::string> results_in(const Job& job, const std::string& out) {
  std::map<std::string, std::string> files;
  for (const std::string& name : job.names(out))
    if (name != "run.json" && name != "log.jsonl") files[name] = text_of(job.file(out + "/" + name));
  return files;
}

TEST(ResultHash, StandsInEveryFile) {
  const Job job("fe/sheet");
  job.put_scan("scan.ply", testing::fe_scan("sheet", testing::usual_options("sheet"), 31));
  ASSERT_TRUE(processed(job.run("scan.ply", "out")));
  const std::string hash = hash_in(job, "out");
  ASSERT_EQ(hash.size(), 64u) << hash;
  for (const std::string& name : job.names("out"))
    EXPECT_TRUE(name == "log.jsonl" || text_of(job.file("out/" + name)).find(hash) != std::string::npos)
        << name;
  EXPECT_EQ(testing::read_table(job.file("out/corrected.csv")).comment, "# result_hash = " + hash);
}

TEST(ResultHash, ChangesWithOneByteOfAnyInput) {
  const Job job("fe/sheet");
  const synthetic::SyntheticScan scan = testing::fe_scan("sheet", testing::usual_options("sheet"), 31);
  job.put("scan.ply", synthetic::double_ply(scan, Vector3d::Zero(), kFloatGridMm));
  job.replace("scan.ply", "format ascii 1.0\n", "format ascii 1.0\ncomment a\n");
  job.replace("cad.stl", text_of(job.file("cad.stl")).substr(0, 8), "drawing ");
  ASSERT_TRUE(processed(job.run("scan.ply", "out")));
  std::set<std::string> hashes = {hash_in(job, "out")};
  const std::vector<std::array<std::string, 3>> changes = {
      {"scan.ply", "comment a", "comment b"}, {"cad.stl", "drawing ", "drawing_"},
      {"path.csv", "# flat", "# Flat"},       {"contour.csv", "# flat", "# Flat"},
      {"recipe.toml", "# flat", "# Flat"},    {"cell.toml", "# The", "# the"}};
  for (const auto& [name, from, to] : changes) {
    job.replace(name, from, to);
    ASSERT_TRUE(processed(job.run("scan.ply", "out_" + name))) << name;
    EXPECT_TRUE(hashes.insert(hash_in(job, "out_" + name)).second) << name;
    const std::string path = text_of(job.file("out_" + name + "/corrected.csv"));
    EXPECT_EQ(path.substr(path.find('\n')), text_of(job.file("out/corrected.csv")).substr(path.find('\n')))
        << "a comment in " << name << " moved the path";
  }
}

TEST(SameBytes, ForAnyThreadCountAndAgain) {
  const Job job("fe/nosecone");
  job.put_scan("scan.ply", testing::fe_scan("nosecone", testing::usual_options("nosecone"), 32));
  ASSERT_TRUE(processed(job.run("scan.ply", "first", "--threads 1")));
  const auto first = results_in(job, "first");
  ASSERT_EQ(first.size(), 6u);
  for (const char* threads : {"1", "2", "8"}) {
    const std::string out = std::string("again") + threads;
    ASSERT_TRUE(processed(job.run("scan.ply", out, std::string("--threads ") + threads)));
    const auto again = results_in(job, out);
    ASSERT_EQ(again.size(), first.size());
    for (const auto& [name, bytes] : first)
      EXPECT_TRUE(again.at(name) == bytes) << name << " with " << threads << " threads";
  }
}

/// Where the part's folder lies on the disk, and the name of the output, are no input.
TEST(SameBytes, InAnotherFolder) {
  const Job here("fe/sheet"), there("fe/sheet");
  const synthetic::SyntheticScan scan = testing::fe_scan("sheet", testing::usual_options("sheet"), 33);
  for (const Job* job : {&here, &there}) {
    job->put_scan("scan.ply", scan);
    ASSERT_EQ(job->arris("--version >/dev/null; touch -d 2020-02-02T02:02:02Z scan.ply").code, 0);
  }
  ASSERT_TRUE(processed(here.run("scan.ply", "out")));
  const std::string folder = there.folder().string() + "/";
  ASSERT_TRUE(processed(testing::run_arris(
      "run " + folder + "recipe.toml --scan " + folder + "scan.ply --out " + folder + "other", "/")));
  const auto a = results_in(here, "out"), b = results_in(there, "other");
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, bytes] : a) EXPECT_TRUE(b.at(name) == bytes) << name;
}

TEST(Metamorphic, ScanMovedTenMetresMovesThePathAlike) {
  const Vector3d shift_mm(6000.0, -8000.0, 1234.5);
  const Job job("fe/porthole");
  job.replace("recipe.toml", "[cell]\nfile = \"cell.toml\"\n", "");  // beyond the robot's reach
  const synthetic::SyntheticScan scan = testing::fe_scan("porthole", testing::usual_options("porthole"), 35);
  job.put("near.ply", synthetic::double_ply(scan, Vector3d::Zero(), kFloatGridMm));
  job.put("far.ply", synthetic::double_ply(scan, shift_mm, kFloatGridMm));
  ASSERT_TRUE(processed(job.run("near.ply", "near")));
  ASSERT_TRUE(processed(job.run("far.ply", "far")));
  EXPECT_FALSE(job.names("near").contains("program.mod")) << "without a cell";
  const Table near = testing::read_table(job.file("near/corrected.csv"));
  const Table far = testing::read_table(job.file("far/corrected.csv"));
  ASSERT_EQ(near.rows.size(), far.rows.size());
  double worst_mm = 0.0, worst_axis = 0.0;
  for (std::size_t row = 0; row < near.rows.size(); ++row) {
    worst_mm = std::max(worst_mm, (near.tip_mm(row) + shift_mm - far.tip_mm(row)).norm());
    worst_axis = std::max(worst_axis, (near.axis(row) - far.axis(row)).norm());
  }
  EXPECT_LT(worst_mm, 1e-3);
  EXPECT_LT(worst_axis, 1e-5);
}

/// Exit 5, the folder with its report, reasons in words, nothing for a robot.
void expect_refused(const Job& job, const Ran& ran, const std::string& reason, const std::string& limit) {
  ASSERT_EQ(ran.code, 5) << ran.out << ran.err;
  EXPECT_EQ(job.names("out"), testing::kRefusedFiles);
  const std::string result = text_of(job.file("out/result.json"));
  ASSERT_TRUE(json::accept(result));
  const json refusals = json::parse(result).at("refusals");
  std::string all;
  for (const json& one : refusals) all += one.get<std::string>() + "\n";
  EXPECT_NE(all.find(reason), std::string::npos) << all;
  EXPECT_NE(all.find(limit), std::string::npos) << all;
  EXPECT_NE(ran.out.find("REFUSED"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find(reason), std::string::npos) << ran.out;
  const std::string report = text_of(job.file("out/report.html"));
  EXPECT_NE(report.find("REFUSED"), std::string::npos);
  EXPECT_NE(report.find(reason), std::string::npos);
  EXPECT_EQ(report.find("program.mod"), std::string::npos) << "no program is offered";
}

TEST(Refused, FlatSheetWhoseSideNothingTells) {
  const Job job("fe/sheet");
  synthetic::ScanOptions options = testing::usual_options("sheet");
  options.write_normals = false;
  job.put_scan("scan.ply", testing::fe_scan("sheet", options, 41));
  expect_refused(job, job.run("scan.ply", "out"), "side", "seen_from");
}

TEST(Refused, CorrectionBeyondItsLimit) {
  const Job job("fe/porthole");
  job.replace("recipe.toml", "max_correction_mm = 20.0", "max_correction_mm = 2.0");
  job.put_scan("scan.ply", testing::fe_scan("porthole", testing::usual_options("porthole"), 42));
  expect_refused(job, job.run("scan.ply", "out"), "shift", "limit 2.00 mm");
}

/// Discs of about 60 mm without points cover the stated share of the contour: refused for the share that is
/// seen, or for the longest gap, with the limit.
void expect_refused_for_gaps(double missing_ratio, std::uint64_t seed) {
  const Job job("fe/nosecone");
  synthetic::ScanOptions options = testing::usual_options("nosecone");
  options.missing_ratio = missing_ratio;
  job.put_scan("scan.ply", testing::fe_scan("nosecone", options, seed));
  const Ran ran = job.run("scan.ply", "out");
  expect_refused(job, ran, "contour 2", "contour 2");
  const bool names_share = ran.out.find("50 % needed") != std::string::npos;
  const bool names_gap = ran.out.find("at most 200") != std::string::npos;
  EXPECT_TRUE(names_share || names_gap) << ran.out;
}

TEST(Refused, MostOfTheContourUnseen) {
  expect_refused_for_gaps(0.6, 43);
}

/// More missing is no better: the borders of the gaps are not taken for the edge.
TEST(Refused, EvenMoreOfTheContourUnseen) {
  expect_refused_for_gaps(0.7, 1);
}

TEST(Refused, ScanOfAnotherPart) {
  const Job job("fe/porthole");
  job.put_scan("scan.ply", testing::fe_scan("nosecone", testing::usual_options("nosecone"), 44));
  const Ran ran = job.run("scan.ply", "out");
  ASSERT_EQ(ran.code, 5) << ran.out << ran.err;
  EXPECT_EQ(job.names("out"), testing::kRefusedFiles);
}

}  // namespace
}  // namespace arris
