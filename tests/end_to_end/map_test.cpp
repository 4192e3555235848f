// arris map: the deviation of every point of a whole scan, and big scans on any number of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "fixtures/synthetic/big_panel.hpp"
#include "fixtures/synthetic/write.hpp"
#include "tests/end_to_end/job.hpp"

namespace arris {
namespace {

using nlohmann::json;
using testing::Job;
using testing::Ran;
using testing::text_of;

constexpr float kRaisedMm = 0.4F;

class SlowMapOfPanel : public ::testing::Test {
 protected:
  void SetUp() override {
    mesh_ = synthetic::big_panel(15.0);
    synthetic::write_mesh(folder_.path() / "panel.stl", mesh_, "panel, mm");
    folder_.write(
        "recipe.toml",
        "schema = 1\n[part]\nnumber = \"panel\"\ncad = \"panel.stl\"\ncad_units = \"mm\"\n[scan]\n"
        "units = \"mm\"\n[scan.initial]\nscan_from_cad = [12.0, 5.0, -3.0, 0.99984770, 0.01047, "
        "-0.01047, 0.00907]\n[contour]\naccept = [2]\n[toolpath]\nfile = \"none.csv\"\n[tolerance]\n"
        "surface_profile_mm = 0.6\ncontour_profile_mm = 0.3\nmax_correction_mm = 20.0\n");
    motion_.translation() = Eigen::Vector3d(4.0, -3.0, 2.0);
  }
  void put(std::vector<Eigen::Vector3f> points) const {
    synthetic::write_points_ply(folder_.path() / "scan.ply", points);
  }
  [[nodiscard]] Ran map(const std::string& more) const {
    return testing::run_arris("map recipe.toml --scan scan.ply " + more, folder_.path());
  }

  testing::TestFolder folder_;
  TriangleMesh mesh_;
  RigidMotion motion_ = RigidMotion::Identity();
};

/// Deviations of a map, read by the words of its header alone.
std::vector<float> deviations_in(const std::string& bytes, std::size_t points) {
  const std::string mark = "end_header\n";
  const std::size_t body = bytes.find(mark) + mark.size();
  EXPECT_EQ(bytes.size(), body + 19 * points);
  std::vector<float> deviations(points);
  for (std::size_t i = 0; i < points; ++i) std::memcpy(&deviations[i], bytes.data() + body + 19 * i + 12, 4);
  return deviations;
}

TEST_F(SlowMapOfPanel, ShowsWhatStandsOutAndNothingElse) {
  auto points = synthetic::scan_of(mesh_, 50000, 0.02, RigidMotion::Identity(), 1);
  std::vector<char> raised(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    raised[i] = std::hypot(points[i].x() - 250.0F, points[i].y() + 330.0F) < 40.0F ? 1 : 0;
    if (raised[i]) points[i].z() += kRaisedMm;
    points[i] = (motion_ * points[i].cast<double>()).cast<float>();
  }
  put(points);
  const Ran ran = map("--out map.ply --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const json told = json::parse(ran.out);
  EXPECT_EQ(told.at("points"), 50000);
  EXPECT_NEAR(told.at("scan_from_cad").at(3).get<double>(), 4.0, 0.02);
  const std::vector<float> deviation = deviations_in(text_of(folder_.path() / "map.ply"), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::isnan(deviation[i])) continue;              // at a border
    const float normal_share = raised[i] ? 0.9F : 0.0F;  // raised along z, measured along the normal
    EXPECT_NEAR(deviation[i], normal_share * kRaisedMm, 0.15F) << i;
  }
  EXPECT_GT(told.at("points_on_drawing").get<int>(), 45000);
}

TEST_F(SlowMapOfPanel, SameBytesForAnyThreadCountInAnyOrder) {
  auto points = synthetic::scan_of(mesh_, 300000, 0.05, motion_, 2);
  for (const bool shuffled : {false, true}) {
    if (shuffled) synthetic::shuffle(points, 3);
    put(points);
    std::string first;
    for (const char* threads : {"1", "2", "8"}) {
      const Ran ran = map(std::string("--out map.ply --threads ") + threads);
      ASSERT_EQ(ran.code, 0) << ran.err;
      const std::string bytes = text_of(folder_.path() / "map.ply");
      if (first.empty()) first = bytes;
      EXPECT_TRUE(first == bytes) << threads << " threads";
    }
  }
}

TEST_F(SlowMapOfPanel, FindsThePoseByItselfAndNamesWhatItCannot) {
  const Job job("fe/porthole");
  synthetic::ScanOptions options = testing::usual_options("porthole");
  options.points = 40000;  // more than the pose is searched on
  options.band_mm = 0.0;
  job.put_scan("scan.ply", testing::fe_scan("porthole", options, 5));
  const Ran ran = job.arris("map recipe.toml --scan scan.ply");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(job.names().contains("scan.map.ply"));
  put(synthetic::scan_of(mesh_, 2000, 0.05, RigidMotion(Eigen::Translation3d(0, 0, 400.0)), 6));
  const Ran off = map("");
  EXPECT_EQ(off.code, 3);
  EXPECT_NE(off.err.find("does not fit"), std::string::npos) << off.err;
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "scan.map.ply"));
}

TEST(SlowBigScan, SameResultHashForAnyThreadCount) {
  const Job job("fe/porthole");
  synthetic::ScanOptions options = testing::usual_options("porthole");
  options.points = 100000;
  job.put_scan("scan.ply", testing::fe_scan("porthole", options, 7));
  std::string first;
  for (const char* threads : {"1", "2", "8"}) {
    const Ran ran = job.run("scan.ply", std::string("out") + threads, std::string("--threads ") + threads);
    ASSERT_TRUE(ran.code == 0 || ran.code == 4 || ran.code == 7) << ran.err;
    const std::string out = std::string("out") + threads + "/";
    const std::string hash = json::parse(text_of(job.file(out + "result.json"))).at("result_hash");
    if (first.empty()) first = hash;
    EXPECT_EQ(first, hash) << threads << " threads";
    EXPECT_TRUE(text_of(job.file("out1/deviation.ply")) == text_of(job.file(out + "deviation.ply")));
  }
}

}  // namespace
}  // namespace arris
