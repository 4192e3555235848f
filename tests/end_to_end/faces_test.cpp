// One plate of 10 mm, bent to a cylinder, whose faces have closed forms: given as its scanned face, its other
// face, its mid-surface and its solid, with the path on either face and points on the wall of the cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <ostream>

#include "fixtures/synthetic/analytic_part.hpp"
#include "fixtures/synthetic/write.hpp"
#include "tests/end_to_end/job.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;
using synthetic::EdgePoint;
using testing::Job;
using testing::Ran;
using testing::Table;

constexpr double kThicknessMm = 10.0;
constexpr double kMeanMm = 0.10, kMaxMm = 0.35;  // of a path on the scanned face from the true rim
constexpr double kFarMoreMm = 0.02;  // a path on the far face, with walls, at most so much farther
constexpr double kAxisMeanDeg = 0.5;
constexpr double kWallRatio = 0.02;   // points on the wall of the cut a face point: one for each mm of rim
constexpr double kSamePathMm = 0.02;  // whichever surface the drawing is

synthetic::PlatePart thick_plate() {
  synthetic::PlateShape shape = synthetic::asymmetric_plate();
  shape.thickness_mm = kThicknessMm;
  shape.bend_curvature_per_mm = 1.0 / 1500.0;
  shape.twist_rad_per_mm = 0.0;  // so that fibres stand on every layer
  return synthetic::PlatePart(shape);
}

synthetic::SyntheticScan scan_of(const synthetic::PlatePart& part, double wall_ratio) {
  synthetic::ScanOptions options;
  options.points = 24000;
  options.band_mm = 0.0;  // the holes beside the opening tell its two turns apart
  options.wall_ratio = wall_ratio;
  return synthetic::sample_scan(part, options, 31);
}

std::string csv_of(const std::vector<EdgePoint>& edge, bool far) {
  std::string text = "x,y,z,nx,ny,nz,path,closed\n";
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const EdgePoint& p = edge[far ? edge.size() - 1 - i : i];  // material on the left, seen from its own face
    const Vector3d n = far ? Vector3d(-p.nominal_normal) : p.nominal_normal;
    char row[160];
    std::snprintf(row, sizeof row, "%.5f,%.5f,%.5f,%.6f,%.6f,%.6f,1,1\n", p.nominal_mm.x(), p.nominal_mm.y(),
                  p.nominal_mm.z(), n.x(), n.y(), n.z());
    text += row;
  }
  return text;
}

/// The rim on a face as it is in the scan; of the far face with the normals that leave it.
std::vector<EdgePoint> true_rim(const synthetic::PlatePart& part, const synthetic::SyntheticScan& scan,
                                bool far) {
  std::vector<EdgePoint> rim = part.edge_at_depth(0, 0.5, far ? kThicknessMm : 0.0);
  for (EdgePoint& p : rim) {
    p.true_mm = scan.scan_from_cad * p.true_mm;
    p.true_normal = (far ? -1.0 : 1.0) * (scan.scan_from_cad.linear() * p.true_normal);
  }
  return rim;
}

/// A folder with the plate drawn as `cad_is`, its contour on that surface and its path on a face.
class PlateJob : public Job {
 public:
  PlateJob(const std::string& cad_is, bool far_path, double wall_ratio)
      : Job("faces"), part(thick_plate()), scan(scan_of(part, wall_ratio)) {
    replace("recipe.toml", "\"scanned_face\"", "\"" + cad_is + "\"");
    if (far_path) replace("recipe.toml", "\"scanned\"", "\"other\"");
    draw(cad_is);
    put("path.csv", csv_of(part.edge_at_depth(0, 2.0, far_path ? kThicknessMm : 0.0), far_path));
    put_scan("scan.ply", scan);
  }

  void draw(const std::string& cad_is) const {
    const bool other = cad_is == "other_face";
    const double depth_mm = other ? kThicknessMm : cad_is == "mid" ? 0.5 * kThicknessMm : 0.0;
    const TriangleMesh mesh =
        cad_is == "solid" ? part.solid_mesh(8.0) : part.layer_mesh(8.0, depth_mm, other);
    synthetic::write_mesh(file("cad.stl"), mesh, "plate10");
    put("contour.csv", csv_of(part.edge_at_depth(0, 1.0, depth_mm), other));
  }

  /// The opening's id on the layer at a height, as `arris contours` numbers it.
  [[nodiscard]] int id_at(double z_mm) const {
    EXPECT_EQ(arris("contours cad.stl --accept 1 --out contours.json").code, 0);
    const auto json = nlohmann::json::parse(testing::text_of(file("contours.json")));
    for (const auto& contour : json.at("contours")) {
      const auto& points = contour.at("points_mm");
      const bool is_opening = std::all_of(points.begin(), points.end(), [&](const auto& p) {
        const Vector3d at_mm(p.at(0), p.at(1), p.at(2));
        const double reach_mm = (at_mm.head<2>() - Eigen::Vector2d(-20.0, 10.0)).norm();
        return std::abs(at_mm.z() - z_mm) < 0.01 && reach_mm < 100.0;
      });
      if (is_opening) return contour.at("id").get<int>();
    }
    return 0;
  }

  const synthetic::PlatePart part;
  const synthetic::SyntheticScan scan;
};

bool accepted(const Ran& ran) {
  return ran.code == 0 || ran.code == 4 || ran.code == 7;
}

struct FaceCase {
  const char* cad_is;
  bool far_path;
};
std::ostream& operator<<(std::ostream& out, const FaceCase& c) {
  return out << c.cad_is << (c.far_path ? "_far" : "_scanned");
}

class Faces : public ::testing::TestWithParam<FaceCase> {};

TEST_P(Faces, PathOnEitherFaceLiesOnItsTrueRim) {
  const auto& [cad_is, far_path] = GetParam();
  const PlateJob job(cad_is, far_path, kWallRatio);
  const Ran ran = job.run("scan.ply", "out");
  ASSERT_TRUE(accepted(ran)) << ran.code << ran.out << ran.err;
  const Table corrected = testing::read_table(job.file("out/corrected.csv"));
  const testing::PathError error = testing::error_to(corrected, true_rim(job.part, job.scan, far_path));
  EXPECT_LT(error.mean_mm, kMeanMm + (far_path ? kFarMoreMm : 0.0));
  EXPECT_LT(error.max_mm, kMaxMm + (far_path ? kFarMoreMm : 0.0));
  EXPECT_LT(error.axis_mean_deg, kAxisMeanDeg);
}

INSTANTIATE_TEST_SUITE_P(Drawn, Faces,
                         ::testing::Values(FaceCase{"scanned_face", false}, FaceCase{"scanned_face", true},
                                           FaceCase{"other_face", true}, FaceCase{"mid", false},
                                           FaceCase{"mid", true}, FaceCase{"solid", true}),
                         [](const auto& one) {
                           return std::string(one.param.cad_is) + (one.param.far_path ? "_far" : "_scanned");
                         });

TEST(FacesAlike, WhateverIsDrawnThePathIsTheSame) {
  const PlateJob job("scanned_face", false, kWallRatio);
  ASSERT_TRUE(accepted(job.run("scan.ply", "scanned_face")));
  const Table plain = testing::read_table(job.file("scanned_face/corrected.csv"));
  std::string before = "scanned_face";
  for (const std::string cad_is : {"other_face", "mid", "solid"}) {
    job.replace("recipe.toml", "\"" + before + "\"", "\"" + cad_is + "\"");
    job.draw(cad_is);
    const Ran ran = job.run("scan.ply", cad_is);
    ASSERT_TRUE(accepted(ran)) << cad_is << ran.out << ran.err;
    const Table same = testing::read_table(job.file(cad_is + "/corrected.csv"));
    ASSERT_EQ(same.rows.size(), plain.rows.size());
    for (std::size_t row = 0; row < same.rows.size(); ++row)
      ASSERT_LT((same.tip_mm(row) - plain.tip_mm(row)).norm(), kSamePathMm) << cad_is << ", row " << row;
    before = cad_is;
  }
}

/// Bent, face and far face alike, with walls and without: the walls pull no path by more than the edge limit
/// allows anyway.
TEST(FacesAlike, WallsDoNotPull) {
  for (const bool far_path : {false, true}) {
    const PlateJob clean("scanned_face", far_path, 0.0), walls("scanned_face", far_path, kWallRatio);
    ASSERT_TRUE(accepted(clean.run("scan.ply", "out")));
    ASSERT_TRUE(accepted(walls.run("scan.ply", "out")));
    const auto mean_mm = [&](const PlateJob& job) {
      return testing::error_to(testing::read_table(job.file("out/corrected.csv")),
                               true_rim(job.part, job.scan, far_path))
          .mean_mm;
    };
    EXPECT_LT(mean_mm(walls), mean_mm(clean) + kFarMoreMm);
  }
}

/// With and without points on the wall between the rims.
class SolidRims : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Walls, SolidRims, ::testing::Values(0.0, 0.03),
                         [](const auto& one) { return one.param > 0.0 ? "Seen" : "Unseen"; });

TEST_P(SolidRims, FarRimIsReplacedByItsPartnerAndNamed) {
  const PlateJob job("solid", false, GetParam());
  const int top = job.id_at(0.0), bottom = job.id_at(-kThicknessMm);
  ASSERT_NE(top, bottom);
  ASSERT_GT(top * bottom, 0);
  job.replace("recipe.toml", "file = \"contour.csv\"", "accept = [" + std::to_string(bottom) + "]");
  const Ran ran = job.run("scan.ply", "out");
  ASSERT_TRUE(accepted(ran)) << ran.out << ran.err;
  const std::string line = "contour " + std::to_string(bottom) +
                           " lies on the far face; its rim on the scanned face, contour " +
                           std::to_string(top) + ", is used";
  EXPECT_NE(ran.out.find(line), std::string::npos) << ran.out;
  EXPECT_NE(testing::text_of(job.file("out/report.html")).find(line), std::string::npos);
  const testing::PathError error = testing::error_to(testing::read_table(job.file("out/corrected.csv")),
                                                     true_rim(job.part, job.scan, false));
  EXPECT_LT(error.mean_mm, kMeanMm);
}

TEST_P(SolidRims, RimOnTheScannedFaceIsNamedToo) {
  const PlateJob job("solid", false, GetParam());
  const int top = job.id_at(0.0);
  ASSERT_GT(top, 0);
  job.replace("recipe.toml", "file = \"contour.csv\"", "accept = [" + std::to_string(top) + "]");
  const Ran ran = job.run("scan.ply", "out");
  ASSERT_TRUE(accepted(ran)) << ran.out << ran.err;
  const std::string line = "contour " + std::to_string(top) + " lies on the scanned face; it is used";
  EXPECT_NE(ran.out.find("face         " + line), std::string::npos) << ran.out;
  EXPECT_NE(testing::text_of(job.file("out/report.html")).find(line), std::string::npos);
  const testing::PathError error = testing::error_to(testing::read_table(job.file("out/corrected.csv")),
                                                     true_rim(job.part, job.scan, false));
  EXPECT_LT(error.mean_mm, kMeanMm);
}

TEST_P(SolidRims, PathFromTheContourRunsOnTheFarRim) {
  const PlateJob job("solid", true, GetParam());
  job.replace("recipe.toml", "file = \"path.csv\"\n", "");
  job.replace("recipe.toml", "thickness_mm = 10.0\n", "");  // the solid says it
  job.put("recipe.toml",
          testing::text_of(job.file("recipe.toml")) + "[toolpath.from_contour]\nstep_mm = 2.0\n");
  const Ran ran = job.run("scan.ply", "out");
  ASSERT_TRUE(accepted(ran)) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("the solid is 10.000 mm thick"), std::string::npos) << ran.out;
  const testing::PathError error = testing::error_to(testing::read_table(job.file("out/corrected.csv")),
                                                     true_rim(job.part, job.scan, true));
  EXPECT_LT(error.mean_mm, kMeanMm + kFarMoreMm);
  EXPECT_LT(error.axis_mean_deg, kAxisMeanDeg);
}

/// Exit code 3 with these words on stderr, and no folder.
void expect_refused(const PlateJob& job, const std::string& words) {
  const Ran ran = job.run("scan.ply", "out");
  EXPECT_EQ(ran.code, 3) << ran.out;
  EXPECT_NE(ran.err.find(words), std::string::npos) << ran.err;
  EXPECT_FALSE(job.names().contains("out"));
}

TEST_P(SolidRims, WrongFaceIsNamedByItsMirrorImage) {
  const PlateJob job("solid", true,
                     GetParam());  // axes leave the face below, and the recipe calls it scanned
  job.replace("recipe.toml", "\"other\"", "\"scanned\"");
  expect_refused(job, "the scan is mirrored, or shows the other face");
}

TEST(WrongDrawings, AreNamed) {
  const PlateJob thick("solid", false, 0.0);
  thick.replace("recipe.toml", "10.0", "8.0");
  expect_refused(thick, "part.thickness_mm is not the solid's thickness");

  const PlateJob inverted("solid", false, 0.0);
  TriangleMesh mesh = inverted.part.solid_mesh(8.0);
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  synthetic::write_mesh(inverted.file("cad.stl"), mesh, "inverted");
  expect_refused(inverted, "the CAD mesh is inverted");

  const PlateJob open("scanned_face", false, 0.0);
  open.replace("recipe.toml", "\"scanned_face\"", "\"solid\"");
  expect_refused(open, "found an open mesh");

  const PlateJob closed("solid", false, 0.0);
  closed.replace("recipe.toml", "\"solid\"", "\"mid\"");
  expect_refused(closed, "found a closed mesh");

  const PlateJob down("mid", false, 0.0);  // a mid-surface whose normals point away from the scanner
  synthetic::write_mesh(down.file("cad.stl"), down.part.layer_mesh(8.0, 0.5 * kThicknessMm, true), "down");
  down.put("contour.csv", csv_of(down.part.edge_at_depth(0, 1.0, 0.5 * kThicknessMm), true));
  expect_refused(down, "the CAD mesh is inverted");

  const PlateJob axes("scanned_face", true, 0.0);
  axes.replace("recipe.toml", "\"other\"", "\"scanned\"");
  expect_refused(axes, "tool axes (toolpath.face = \"scanned\")");
}

/// The plate as scanned, stretched in all directions.
Ran stretched_run(const PlateJob& job, double ratio) {
  synthetic::SyntheticScan scan = job.scan;
  for (Vector3d& p : scan.points_mm) p *= 1.0 + ratio;
  job.put_scan("scan.ply", scan);
  return job.run("scan.ply", "out --force");
}

TEST(Release, StretchedPlateAndPermanentShapeWarn) {
  const PlateJob job("mid", false, 0.0);
  const std::string warning = "letting the part go will not bring the contour back";
  const Ran bent = stretched_run(job, 0.0), stretched = stretched_run(job, 0.005);
  ASSERT_TRUE(accepted(bent) && accepted(stretched)) << stretched.out;
  EXPECT_EQ(bent.out.find(warning), std::string::npos) << bent.out;
  EXPECT_NE(stretched.out.find(warning), std::string::npos) << stretched.out;
  const auto result = nlohmann::json::parse(testing::text_of(job.file("out/result.json")));
  EXPECT_NEAR(result.at("registration").at("mean_strain_ratio").get<double>(), 0.005, 0.0015);
  EXPECT_EQ(result.at("registration").at("mean_strain_at"), "mid-surface");
  EXPECT_NE(testing::text_of(job.file("out/report.html")).find(warning), std::string::npos);
  job.replace("recipe.toml", "thickness_mm = 10.0", "thickness_mm = 10.0\nstate = \"free\"");
  const Ran free = stretched_run(job, 0.0);
  EXPECT_NE(free.out.find(warning), std::string::npos) << free.out;
}

}  // namespace
}  // namespace arris
