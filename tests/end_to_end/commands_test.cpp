// The other commands on the same parts: inspect, contours with the operator's choice, info, the demo.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "fixtures/synthetic/analytic_part.hpp"
#include "tests/end_to_end/job.hpp"

namespace arris {
namespace {

using nlohmann::json;
using testing::Job;
using testing::Ran;
using testing::text_of;

bool processed(const Ran& ran) {
  return ran.code == 0 || ran.code == 4 || ran.code == 7;
}

/// Ids of the contours in `arris contours --json`, longest first.
std::vector<int> longest_first(const json& listing) {
  std::vector<std::pair<double, int>> loops;
  for (const json& one : listing.at("contours"))
    loops.emplace_back(-one.at("length_mm").get<double>(), one.at("id").get<int>());
  std::sort(loops.begin(), loops.end());
  std::vector<int> ids;
  for (const auto& [length, id] : loops) ids.push_back(id);
  return ids;
}

TEST(Inspect, JudgesWithoutAPath) {
  const Job job("fe/porthole");
  std::filesystem::remove(job.file("path.csv"));
  std::filesystem::remove(job.file("cell.toml"));
  job.put_scan("scan.ply", testing::fe_scan("porthole", testing::usual_options("porthole"), 61));
  const Ran ran = job.arris("inspect recipe.toml --scan scan.ply --out out");
  ASSERT_TRUE(processed(ran)) << ran.code << ran.err;
  EXPECT_EQ(job.names("out"), testing::kRefusedFiles) << "no path and no program";
}

TEST(Inspect, DefaultOutputIsNamedAfterTheScan) {
  const Job job("fe/sheet");
  job.put_scan("part7.ply", testing::fe_scan("sheet", testing::usual_options("sheet"), 62));
  ASSERT_TRUE(processed(job.arris("inspect recipe.toml --scan part7.ply --json >summary.json")));
  EXPECT_TRUE(job.names().contains("part7.arris"));
  EXPECT_TRUE(json::accept(text_of(job.file("summary.json")))) << text_of(job.file("summary.json"));
  EXPECT_TRUE(json::accept(text_of(job.file("part7.arris/result.json"))));
  EXPECT_TRUE(json::accept(text_of(job.file("part7.arris/run.json"))));
}

TEST(Contours, OperatorsChoiceIsTakenForItsScanAlone) {
  const Job job("fe/porthole");
  job.put_scan("scan.ply", testing::fe_scan("porthole", testing::usual_options("porthole"), 63));
  job.put_scan("other.ply", testing::fe_scan("porthole", testing::usual_options("porthole"), 64));
  const Ran listed = job.arris("contours scan.ply --recipe recipe.toml --json");
  ASSERT_EQ(listed.code, 0) << listed.err;
  ASSERT_TRUE(json::accept(listed.out)) << listed.out;
  // A band of points round the opening has two borders: the opening's is the shorter, the band's the longer.
  const std::vector<int> ids = longest_first(json::parse(listed.out));
  ASSERT_GE(ids.size(), 2u) << listed.out;
  const Ran accepted = job.arris("contours scan.ply --recipe recipe.toml --accept " + std::to_string(ids[1]) +
                                 " --out contours.json --png contours.png");
  ASSERT_EQ(accepted.code, 0) << accepted.err;
  ASSERT_TRUE(json::accept(text_of(job.file("contours.json"))));

  job.replace("recipe.toml", "validation = \"auto\"", "validation = \"operator\"");
  const Ran ran = job.run("scan.ply", "out", "--contours contours.json");
  EXPECT_TRUE(processed(ran)) << ran.code << ran.out << ran.err;
  EXPECT_TRUE(job.names("out").contains("corrected.csv"));

  const Ran refused = job.run("other.ply", "out2", "--contours contours.json");
  EXPECT_EQ(refused.code, 3) << refused.err;
  EXPECT_NE(refused.err.find("contours.json"), std::string::npos) << refused.err;
  EXPECT_FALSE(job.names().contains("out2"));
}

TEST(Contours, ALoopThatTheOperatorRejectedIsNotFollowed) {
  const Job job("example");
  synthetic::ScanOptions whole_face;
  whole_face.points = 12000;
  whole_face.band_mm = 0.0;
  job.put_scan("scan.ply",
               synthetic::sample_scan(synthetic::PlatePart(synthetic::asymmetric_plate()), whole_face, 66));
  const Ran listed = job.arris("contours scan.ply --recipe recipe.toml --json");
  ASSERT_EQ(listed.code, 0) << listed.err;
  const std::vector<int> ids = longest_first(json::parse(listed.out));
  ASSERT_GE(ids.size(), 4u) << listed.out;  // border, opening, two datum holes
  const auto accept = [&](const std::string& which) {
    return job.arris("contours scan.ply --recipe recipe.toml --out contours.json --accept " + which).code;
  };
  const auto id = [&](std::size_t i) { return std::to_string(ids[i]); };
  ASSERT_EQ(accept(id(0) + "," + id(1) + "," + id(2) + "," + id(3)), 0);
  EXPECT_TRUE(processed(job.run("scan.ply", "all", "--contours contours.json")));
  for (const std::string& others : {id(0), id(2), id(0) + "," + id(2) + "," + id(3)}) {
    ASSERT_EQ(accept(others), 0);
    const Ran ran = job.run("scan.ply", "others", "--force --contours contours.json");
    EXPECT_EQ(ran.code, 5) << others << ran.out << ran.err;
    EXPECT_FALSE(job.names("others").contains("program.mod"));
  }
}

TEST(Json, OfEveryCommandParses) {
  const Job job("fe/sheet");
  job.put_scan("scan.ply", testing::fe_scan("sheet", testing::usual_options("sheet"), 65));
  for (const char* line :
       {"info scan.ply --json", "info cad.stl --json", "contours cad.stl --json", "contours scan.ply --json",
        "recipe check recipe.toml --json", "recipe print --json", "recipe print --json recipe.toml",
        "recipe print --json --cell", "recipe print --json --cell cell.toml",
        "recipe new --json --cad cad.stl", "recipe new --json --cad cad.stl --out new.toml",
        "run recipe.toml --scan scan.ply --out out --json",
        "inspect recipe.toml --scan scan.ply --out shape --json",
        "batch recipe.toml scan.ply --out many --json", "demo --out demo --json"}) {
    const Ran ran = job.arris(line);
    EXPECT_TRUE(processed(ran)) << line << ran.code << ran.err;
    EXPECT_TRUE(json::accept(ran.out)) << line << "\n" << ran.out;
  }
  const json run = json::parse(job.arris("run recipe.toml --scan scan.ply --out out --force --json").out);
  EXPECT_TRUE(run.is_object());
  EXPECT_EQ(job.names("out"), testing::kAcceptedFiles) << "--force replaces a run's own folder";
}

TEST(Json, OfRecipePrintHoldsEveryKeyWithItsValue) {
  const Job job("fe/sheet");
  const json printed = json::parse(job.arris("recipe print recipe.toml --json").out);
  EXPECT_EQ(printed.at("file"), "recipe.toml");
  std::map<std::string, json> keys;
  for (const json& key : printed.at("keys")) {
    EXPECT_FALSE(key.at("about").get<std::string>().empty()) << key;
    keys[key.at("key")] = key;
  }
  EXPECT_EQ(keys.at("part.cad").at("value"), "cad.stl");
  EXPECT_EQ(keys.at("part.cad").at("required"), true);
  EXPECT_EQ(keys.at("scan.initial.scan_from_cad").at("value"), nullptr) << "a table that is not there";
  EXPECT_TRUE(keys.at("toolpath.path_reach_mm").at("value").is_number());
  EXPECT_EQ(keys.at("toolpath.path_reach_mm").at("required"), false);
  EXPECT_EQ(keys.at("contour.accept").at("value"), nullptr) << "not set";
  // The TOML that a person reads has a line a key, commented out or not.
  std::istringstream toml(job.arris("recipe print recipe.toml").out);
  const std::regex key_line("(# )?[a-z_0-9]+ = .*");
  std::size_t lines = 0;
  for (std::string line; std::getline(toml, line);) lines += std::regex_match(line, key_line) ? 1 : 0;
  EXPECT_EQ(lines, keys.size());
}

TEST(Json, OfRecipePrintHoldsACellsLists) {
  const Job job("fe/sheet");
  const json printed = json::parse(job.arris("recipe print --cell cell.toml --json").out);
  for (const json& key : printed.at("keys"))
    if (key.at("key") == "frames.robot_from_scan.xyz_mm") {
      EXPECT_EQ(key.at("value"), json({850.0, 0.0, 400.0}));
      return;
    }
  FAIL() << printed;
}

TEST(Json, OfRecipeNewHoldsTheRecipeAndWhereItIs) {
  const Job job("fe/sheet");
  const json shown = json::parse(job.arris("recipe new --cad cad.stl --json").out);
  EXPECT_EQ(shown.at("file"), nullptr);
  const json written = json::parse(job.arris("recipe new --cad cad.stl --out new.toml --json").out);
  EXPECT_EQ(written.at("file"), "new.toml");
  EXPECT_EQ(written.at("recipe"), text_of(job.file("new.toml")));
  EXPECT_EQ(written.at("recipe"), shown.at("recipe"));
}

TEST(Demo, EndsInToleranceWithAReport) {
  const Job job("fe/sheet");
  const Ran ran = job.arris("demo --out demo");
  ASSERT_EQ(ran.code, 0) << ran.out << ran.err;
  std::size_t reports = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(job.file("demo")))
    if (entry.path().filename() == "report.html") {
      ++reports;
      EXPECT_GT(entry.file_size(), 10000u);
      EXPECT_NE(ran.out.find("report.html"), std::string::npos) << ran.out;
    }
  EXPECT_EQ(reports, 1u);
}

}  // namespace
}  // namespace arris
