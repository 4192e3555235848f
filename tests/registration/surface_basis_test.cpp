#include "registration/surface_basis.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "registration/edge_support.hpp"
#include "registration/surface_shape.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using synthetic::PlatePart;

/// Nodes of a flat plate with an opening, and a few places on it.
struct Plate {
  CadModel cad = scenes::cad_of(PlatePart(synthetic::plate_with_rounded_rectangle()));
  std::vector<SurfaceCell> cells = band_cells(cad, 60.0, 12.0);
  NodeSpacing spacing{30.0};
  SurfaceBasis basis{place_nodes({&cad.contours[0]}, cells, spacing)};

  std::vector<Eigen::Vector3d> at_nodes(const std::function<Eigen::Vector3d(double, double)>& f) const {
    std::vector<Eigen::Vector3d> values;
    for (const Eigen::Vector3d& p : basis.nodes().points_mm) values.push_back(f(p.x(), p.y()));
    return values;
  }
};

/// Nodes evenly spaced, and closer together beside the opening.
const std::vector<NodeSpacing> kSpacings = {NodeSpacing(30.0), NodeSpacing(13.0, 30.0)};
Plate plate_with(const NodeSpacing& spacing) {
  Plate plate;
  plate.cells = band_cells(plate.cad, 60.0, 0.4 * spacing.beside_mm);
  plate.spacing = spacing;
  plate.basis = SurfaceBasis(place_nodes({&plate.cad.contours[0]}, plate.cells, spacing));
  return plate;
}

TEST(SurfaceNodes, CellsHoldTheBandsArea) {
  const PlatePart part(synthetic::plate_with_rounded_rectangle());
  const Plate plate;
  double area_mm2 = 0.0, fewer_mm2 = 0.0;
  for (const SurfaceCell& cell : plate.cells) area_mm2 += cell.area_mm2;
  for (const SurfaceCell& cell : thinned(plate.cells, 30.0, 0.67)) fewer_mm2 += cell.area_mm2;
  EXPECT_NEAR(area_mm2 / part.band_area_mm2(60.0), 1.0, 0.03);
  EXPECT_NEAR(fewer_mm2, area_mm2, 1e-6 * area_mm2);
  EXPECT_LT(thinned(plate.cells, 30.0, 0.67).size(), plate.cells.size());
}

TEST(SurfaceNodes, EveryCellHasANodeNearAndNoneAreOnTopOfEachOther) {
  for (const NodeSpacing& spacing : kSpacings) {
    const Plate plate = plate_with(spacing);
    const std::vector<Eigen::Vector3d>& nodes = plate.basis.nodes().points_mm;
    for (const SurfaceCell& cell : plate.cells) {
      double nearest_mm = 1e300;
      for (const Eigen::Vector3d& p : nodes) nearest_mm = std::min(nearest_mm, (p - cell.centre_mm).norm());
      EXPECT_LE(nearest_mm, 0.75 * spacing.at(cell.to_contours_mm) + 1e-9);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (std::size_t j = i + 1; j < nodes.size(); ++j)
        EXPECT_GT((nodes[i] - nodes[j]).norm(), spacing.beside_mm / 6.0) << i << " " << j;
  }
}

TEST(SurfaceNodes, AreFewWhereTheyMayBeFartherApart) {
  const std::size_t all_close = plate_with(13.0).basis.size();
  EXPECT_LT(3 * plate_with({13.0, 30.0}).basis.size(), 2 * all_close);
  EXPECT_GT(plate_with({13.0, 30.0}).basis.size(), 2 * plate_with(30.0).basis.size());
}

TEST(SurfaceBasis, WeightsSumToOneAndReproduceWhatIsLinearAndQuadratic) {
  const auto f = [](double x, double y) {
    return Eigen::Vector3d(1.0, 0.2 * x - 0.1 * y, 1e-3 * x * x - 2e-3 * x * y + 5e-4 * y * y);
  };
  for (const NodeSpacing& spacing : kSpacings) {
    const Plate plate = plate_with(spacing);
    const double most_mm = spacing.beside_mm < spacing.far_mm ? 0.02 : 5e-3;  // of a bow of 30 mm
    const std::vector<Eigen::Vector3d> values = plate.at_nodes(f);
    for (std::size_t i = 0; i < plate.cells.size(); i += 7) {
      const Eigen::Vector3d& p = plate.cells[i].centre_mm;
      const BasisRow row = plate.basis.row(p, Eigen::Vector3d::UnitZ());
      ASSERT_TRUE(row.usable());
      EXPECT_LT((row.combine(BasisRow::kValue, values) - f(p.x(), p.y())).norm(), most_mm) << p.transpose();
      EXPECT_NEAR(row.combine(BasisRow::kValue, values).x(), 1.0, 1e-12);
      const Eigen::Vector3d slope = row.combine(BasisRow::kD1, values);
      EXPECT_NEAR(slope.x(), 0.0, 1e-12);
      EXPECT_NEAR(slope.y(), 0.2 * row.t1.x() - 0.1 * row.t1.y(), 1e-10);
    }
  }
}

TEST(SurfaceBasis, IsSmoothAcrossTheBand) {
  const Eigen::Vector3d n = Eigen::Vector3d::UnitZ();
  for (const NodeSpacing& spacing : kSpacings) {
    const Plate plate = plate_with(spacing);
    const std::vector<Eigen::Vector3d> values = plate.at_nodes(
        [](double x, double y) { return Eigen::Vector3d(std::sin(x / 40.0), std::cos(y / 50.0), 0); });
    const Eigen::Vector3d edge_mm = plate.cad.contours[0].point_mm(200.0);
    const Eigen::Vector3d along = plate.cad.contours[0].tangent(200.0), inward = plate.cad.inward(0, 200.0);
    // A step of 0.1 mm changes these values by 0.0025; through node after node, along the edge and away from
    // it.
    for (const auto& [direction, from_mm] : {std::pair(along, -20.0), std::pair(inward, 0.0)}) {
      Eigen::Vector3d before = Eigen::Vector3d::Zero();
      for (double at_mm = from_mm; at_mm < from_mm + 55.0; at_mm += 0.1) {
        const BasisRow row = plate.basis.row(edge_mm + at_mm * direction, n);
        ASSERT_TRUE(row.usable());
        const Eigen::Vector3d here = row.combine(BasisRow::kValue, values);
        if (at_mm > from_mm) {
          EXPECT_LT((here - before).norm(), 0.004) << at_mm;
        }
        before = here;
      }
    }
  }
}

TEST(SurfaceBasis, NodesThatShareARowLieInTheBand) {
  const Plate plate = plate_with({13.0, 30.0});
  for (const SurfaceCell& cell : plate.cells) {
    const BasisRow row = plate.basis.row(cell.centre_mm, Eigen::Vector3d::UnitZ());
    ASSERT_TRUE(row.usable());
    EXPECT_GE(static_cast<std::size_t>(row.node.front()),
              plate.basis.band()->first(static_cast<std::size_t>(row.node.back())));
  }
}

TEST(SheetCell, ARigidMotionNeitherStretchesNorBends) {
  const Plate plate;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Eigen::Vector3d> shift_mm;
  for (const Eigen::Vector3d& p : plate.basis.nodes().points_mm)
    shift_mm.push_back(turn * p + Eigen::Vector3d(5, -7, 9) - p);
  for (std::size_t i = 0; i < plate.cells.size(); i += 11)
    EXPECT_LT(SheetCell(plate.cells[i], plate.basis).mid_strain(shift_mm, 3.0).norm(), 1e-9);
}

TEST(SheetCell, BentToACylinderTheFaceStretchesByHalfTheThicknessAndTheMiddleDoesNot) {
  const Plate plate;
  const double radius_mm = 3000.0, thickness_mm = 4.0;
  // The middle keeps its length: the face at z = 0 lies on the radius R + t/2 and is longer by t / 2R.
  std::vector<Eigen::Vector3d> shift_mm;
  for (const Eigen::Vector3d& p : plate.basis.nodes().points_mm) {
    const double angle = p.x() / radius_mm, r = radius_mm + 0.5 * thickness_mm;
    shift_mm.push_back(Eigen::Vector3d(r * std::sin(angle), p.y(), r * std::cos(angle) - r) - p);
  }
  for (std::size_t i = 0; i < plate.cells.size(); i += 11) {
    const SheetCell cell(plate.cells[i], plate.basis);
    const Eigen::Vector3d face = cell.mid_strain(shift_mm, 0.0),
                          middle = cell.mid_strain(shift_mm, thickness_mm);
    EXPECT_NEAR(face[0] + face[2], 0.5 * thickness_mm / radius_mm, 1e-4);  // of 6.7e-4
    EXPECT_LT(middle.norm(), 1e-4);
  }
}

TEST(SheetCell, ItsDerivativesAreThoseOfItsResiduals) {
  const Plate plate;
  SheetPrior prior;
  prior.thickness_mm = 3.0;
  const SheetCell cell(plate.cells[plate.cells.size() / 2], plate.basis);
  synthetic::Random random(5);
  std::vector<Eigen::Vector3d> shift_mm(plate.basis.size());
  for (Eigen::Vector3d& u : shift_mm)
    u = 0.3 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  // Strain alone decides when bending is free: cost = sum w E^2 / 2, its gradient by central differences.
  prior.bend_per_mm = 1e6;
  const double share = plate.cells[plate.cells.size() / 2].area_mm2 / (50.0 * 50.0);
  const auto cost = [&](const std::vector<Eigen::Vector3d>& u) {
    const Eigen::Vector3d e = cell.mid_strain(u, prior.thickness_mm) / prior.strain_ratio;
    return 0.5 * share * (e[0] * e[0] + 2.0 * e[1] * e[1] + e[2] * e[2]);
  };
  SurfaceSystem system(plate.basis.band(), 0);
  cell.add(shift_mm, prior, system);
  for (const std::int32_t j : cell.row().node)
    for (int axis = 0; axis < 3; ++axis) {
      const double h = 1e-5;
      std::vector<Eigen::Vector3d> more = shift_mm, less = shift_mm;
      more[static_cast<std::size_t>(j)][axis] += h;
      less[static_cast<std::size_t>(j)][axis] -= h;
      const double numeric = (cost(more) - cost(less)) / (2.0 * h);
      EXPECT_NEAR(system.gradient[3 * j + axis], numeric, 1e-4 * system.gradient.norm());
    }
}

TEST(EdgeSupport, IsUnbiasedForAUniformDensityAtAnyScale) {
  // Expected pull of points uniform on [0, infinity) on an edge at 0: the outward one cancels the inward one.
  for (const double tau_mm : {0.03, 0.3, 2.0}) {
    const EdgeSupport support{tau_mm, 40.0 * tau_mm, 0.0};
    double pull = 0.0;
    const double step = 1e-3 * tau_mm;
    for (double g = 0.5 * step; g < support.strip_mm; g += step) pull += support.at(g).slope_per_mm * step;
    EXPECT_NEAR(pull, 0.0, 2e-3) << tau_mm;
  }
}

TEST(EdgeSupport, LetsGoOfStraysAndHoldsTheEdge) {
  const EdgeSupport support{0.1, 10.0, 5e-3};
  EXPECT_LT(std::abs(support.at(-5.0).slope_per_mm), 1e-6);  // far outside: a stray
  EXPECT_LT(support.at(-0.1).slope_per_mm, -1.0);            // just outside: pushes the edge out
  EXPECT_GT(support.at(5.0).slope_per_mm, 0.0);              // well inside: its share of the density
  EXPECT_EQ(support.at(11.0).slope_per_mm, 0.0);             // beyond the strip
}

TEST(EdgeSupport, SlopeIsThatOfTheCostWithAWallAndWithout) {
  const EdgeSupport support{0.05, 10.0, 5e-3};
  for (const double width_mm : {0.0, 0.02, 0.3}) {
    const WallPoints wall{width_mm, 0.06};
    for (double g = -0.4; g < 0.4; g += 0.013) {
      const EdgeSupport::Pull pull = support.at(g, wall);
      const double h = 1e-6;
      EXPECT_NEAR(pull.slope_per_mm,
                  (support.whole_cost(g + h, wall) - support.whole_cost(g - h, wall)) / (2.0 * h),
                  1e-3 * (1.0 + std::abs(pull.slope_per_mm)))
          << g << " " << width_mm;
    }
  }
}

TEST(EdgeSupport, WallPointsAboutTheEdgePullItNowhere) {
  // Expected pull of points uniform inside and of wall points about an edge at 0, by the law they are drawn
  // by.
  const double tau_mm = 0.03, step = 1e-4;
  const WallPoints wall{0.1, 0.06};
  const EdgeSupport support{tau_mm, 40.0 * tau_mm, 0.0};
  double with_wall = 0.0, for_face = 0.0;
  for (double g = -0.6; g < support.strip_mm; g += step) {
    const double density = (g > 0.0 ? 1.0 : 0.0) + wall.ratio(g);
    with_wall += density * support.at(g, wall).slope_per_mm * step;
    for_face += density * support.at(g).slope_per_mm * step;
  }
  EXPECT_LT(for_face, -1.0) << "outward";
  EXPECT_LT(std::abs(with_wall), 0.1 * std::abs(for_face));
}

}  // namespace
}  // namespace arris
