#include <cairo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include "report/picture.hpp"
#include "report/picture_parts.hpp"
#include "report/raster.hpp"
#include "report/scene.hpp"
#include "sample_record.hpp"

namespace arris::report {
namespace {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint32_t> pixels;  ///< 0x00RRGGBB
};

Image decoded(const std::string& png) {
  struct Source {
    const std::string* bytes;
    std::size_t at;
  } source{&png, 0};
  const auto read = [](void* closure, unsigned char* data, unsigned int length) {
    auto* from = static_cast<Source*>(closure);
    if (from->at + length > from->bytes->size()) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(data, from->bytes->data() + from->at, length);
    from->at += length;
    return CAIRO_STATUS_SUCCESS;
  };
  cairo_surface_t* surface = cairo_image_surface_create_from_png_stream(read, &source);
  Image image;
  EXPECT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  image.width = cairo_image_surface_get_width(surface);
  image.height = cairo_image_surface_get_height(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int row = 0; row < image.height; ++row)
    for (int col = 0; col < image.width; ++col) {
      std::uint32_t word = 0;
      std::memcpy(&word, cairo_image_surface_get_data(surface) + row * stride + 4 * col, 4);
      image.pixels.push_back(word & 0xFFFFFFU);
    }
  cairo_surface_destroy(surface);
  return image;
}

std::size_t count_of(const Image& image, const Rgb& colour) {
  const std::uint32_t word =
      (std::uint32_t{colour.red} << 16U) | (std::uint32_t{colour.green} << 8U) | std::uint32_t{colour.blue};
  return static_cast<std::size_t>(std::count(image.pixels.begin(), image.pixels.end(), word));
}

void expect_picture(const std::string& png, std::size_t least_colours) {
  ASSERT_FALSE(png.empty());
  const Image image = decoded(png);
  EXPECT_EQ(image.width, kPictureWidth);
  EXPECT_GT(image.height, 600);
  EXPECT_LT(image.height, 1200);
  EXPECT_GE(std::set<std::uint32_t>(image.pixels.begin(), image.pixels.end()).size(), least_colours);
}

TEST(Picture, DecodesAndIsNotBlank) {
  const RunRecord record = test::sample_record();
  expect_picture(deviation_picture(record, Look::kAlong), 100);
  expect_picture(deviation_picture(record, Look::kOblique), 100);
  expect_picture(path_shift_picture(record), 100);
  expect_picture(path_axes_picture(record), 100);
}

TEST(Picture, SameBytesTwice) {
  const RunRecord record = test::sample_record();
  EXPECT_EQ(deviation_picture(record, Look::kOblique), deviation_picture(record, Look::kOblique));
}

TEST(Picture, NoDataIsHatchedAndScaleEndsAreShown) {
  const Image image = decoded(deviation_picture(test::sample_record(), Look::kAlong));
  EXPECT_GT(count_of(image, no_data_pattern(0, 0)), 5000U);   // the missing patch
  EXPECT_GT(count_of(image, ColourMap::over_scale()), 500U);  // the block beside the scale
  EXPECT_GT(count_of(image, ColourMap::under_scale()), 500U);
}

TEST(Picture, SeenTheSameWhereverThePartLies) {
  // The picture is drawn in the CAD frame: another pose of the same part shows the same colours in the same
  // places.
  RunRecord moved = test::sample_record();
  RigidMotion motion = RigidMotion::Identity();
  motion.linear() = Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto move = [&](Eigen::Vector3d local) { return Eigen::Vector3d(motion * local); };
  RigidMotion local_from_cad = moved.alignment.scan_from_cad;
  local_from_cad.translation() -= moved.cloud.offset_mm;
  for (Eigen::Vector3f& p : moved.cloud.points_mm) p = move(p.cast<double>()).cast<float>();
  moved.alignment.scan_from_cad = motion * local_from_cad;
  moved.alignment.scan_from_cad.translation() += moved.cloud.offset_mm;
  for (auto* contours : {&moved.found_contours, &moved.dropped_contours})
    for (Contour& contour : *contours)
      for (Eigen::Vector3d& p : contour.points_mm) p = move(p);
  for (CorrectedPoint& p : moved.correction.points) p.point.tip_mm = move(p.point.tip_mm);

  const Image a = decoded(deviation_picture(test::sample_record(), Look::kAlong));
  const Image b = decoded(deviation_picture(moved, Look::kAlong));
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  const auto differs = [&](std::size_t i) {
    int most = 0;
    for (const unsigned shift : {0U, 8U, 16U})
      most = std::max(most, std::abs(static_cast<int>((a.pixels[i] >> shift) & 255U) -
                                     static_cast<int>((b.pixels[i] >> shift) & 255U)));
    return most > 12;  // the light may round otherwise
  };
  std::size_t differing = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) differing += differs(i) ? 1U : 0U;
  EXPECT_LT(static_cast<double>(differing), 0.005 * static_cast<double>(a.pixels.size()));
}

TEST(Picture, RefusedRunsHaveNoPathPicture) {
  EXPECT_TRUE(path_shift_picture(test::refused_record()).empty());
  EXPECT_TRUE(path_axes_picture(test::refused_record()).empty());
  expect_picture(deviation_picture(test::refused_record(), Look::kAlong), 100);
  expect_picture(deviation_picture(test::barely_started_record(), Look::kAlong), 10);
}

TEST(Picture, OddRecordsDoNotBreakIt) {
  EXPECT_TRUE(deviation_picture(RunRecord{}, Look::kAlong).empty());
  RunRecord one;
  one.cloud.points_mm = {{1.0F, 2.0F, 3.0F}};
  one.deviation_mm = {0.2F};
  EXPECT_FALSE(deviation_picture(one, Look::kOblique).empty());
  RunRecord line;
  for (int i = 0; i < 50; ++i) line.cloud.points_mm.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
  line.deviation_mm.assign(50, 0.1F);
  EXPECT_FALSE(deviation_picture(line, Look::kAlong).empty());
}

TEST(ContoursPicture, EachLoopInItsOwnColour) {
  const RunRecord record = test::sample_record();
  ContourDrawing drawing;
  drawing.title = "Contours";
  drawing.mesh = &record.cad;
  drawing.contours = record.cad_contours;
  Contour outline;
  outline.id = 2;
  outline.closed = true;
  outline.points_mm = {{-160, -110, 0}, {160, -110, 0}, {160, 110, 0}, {-160, 110, 0}};
  drawing.contours.push_back(outline);
  const Image image = decoded(contours_picture(drawing));
  EXPECT_GT(count_of(image, {0, 114, 178}), 2000U);
  EXPECT_GT(count_of(image, {213, 94, 0}), 2000U);
  EXPECT_TRUE(contours_picture(ContourDrawing{}).empty());
  drawing.mesh = nullptr;
  drawing.dropped = {outline};
  EXPECT_FALSE(contours_picture(drawing).empty());
}

TEST(Labels, DoNotOverlapAndStayInside) {
  std::vector<Eigen::Vector2d> anchors, sizes;
  for (int i = 0; i < 12; ++i) {
    anchors.emplace_back(300.0 + 11.0 * (i % 4), 250.0 + 9.0 * (i / 4));  // crowded
    sizes.emplace_back(150.0, 38.0);
  }
  const Box bounds{0, 0, 1000, 700}, taken{0, 600, 300, 100};
  const std::vector<Box> boxes = place_labels(anchors, sizes, bounds, {taken});
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    ASSERT_GT(boxes[i].width, 0.0) << i;
    EXPECT_FALSE(boxes[i].overlaps(taken));
    EXPECT_TRUE(bounds.holds({boxes[i].x, boxes[i].y}));
    EXPECT_TRUE(bounds.holds({boxes[i].x + boxes[i].width, boxes[i].y + boxes[i].height}));
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(boxes[i].overlaps(boxes[j])) << i << " " << j;
    for (const Eigen::Vector2d& anchor : anchors) EXPECT_FALSE(boxes[i].holds(anchor));
  }
}

TEST(Labels, SpreadKeepsOrderGapAndLimits) {
  const std::vector<double> places = spread({10.0, 11.0, 12.0, 50.0, 99.0}, 20.0, 0.0, 100.0);
  EXPECT_GE(places.front(), 0.0);
  EXPECT_LE(places.back(), 100.0);
  for (std::size_t i = 1; i < places.size(); ++i) EXPECT_GE(places[i] - places[i - 1], 20.0 - 1e-9);
  EXPECT_EQ(spread({10.0, 50.0}, 20.0, 0.0, 100.0), (std::vector<double>{10.0, 50.0}));
}

TEST(Raster, NearPointsHideFarOnes) {
  Raster raster(20, 20, {255, 255, 255});
  raster.splat({10, 10, 5.0}, 4.0, 0.1, {1, 2, 3});
  raster.splat({10, 10, 2.0}, 4.0, 0.1, {9, 9, 9});
  EXPECT_EQ(raster.colour(10, 10), (Rgb{1, 2, 3}));
  EXPECT_FALSE(raster.is_covered(1, 1));
  EXPECT_FALSE(raster.sees({10, 10, 2.0}, 1.0));
  EXPECT_TRUE(raster.sees({10, 10, 4.5}, 1.0));
  EXPECT_TRUE(raster.sees({1, 1, -100.0}, 1.0));
}

TEST(Raster, ErodeBringsOutlinesBackAndKeepsGapsClosed) {
  Raster raster(200, 60, {255, 255, 255});
  for (int i = 0; i < 15; ++i) raster.splat({40.0 + 8.0 * i, 30.0, 0.0}, 16.0, 0.1, {1, 2, 3});
  raster.erode(10.0, {255, 255, 255});
  EXPECT_TRUE(raster.is_covered(44, 30));   // between two points
  EXPECT_TRUE(raster.is_covered(36, 30));   // 4 px out of the first: radius 16 less 10
  EXPECT_FALSE(raster.is_covered(28, 30));  // 12 px out
  EXPECT_FALSE(raster.is_covered(100, 10));
}

TEST(View, OrientationsAreRotationsAndFit) {
  const RunRecord record = test::sample_record();
  const std::vector<Eigen::Vector3d> points = points_in_cad_mm(record);
  const Orientation along = look_along(mean_normal(record, points), points);
  EXPECT_NEAR((along - Orientation::Identity()).norm(), 0.0, 1e-9);  // X to the right, Y up, seen from +Z
  for (const Orientation& orientation : {along, look_oblique(along)}) {
    EXPECT_NEAR((orientation * orientation.transpose() - Orientation::Identity()).norm(), 0.0, 1e-12);
    EXPECT_NEAR(orientation.determinant(), 1.0, 1e-12);
    const Box box{100, 50, 800, 400};
    const View view = fit_view(orientation, extent_of(orientation, points), box, 20.0);
    std::size_t inside = 0;
    for (const Eigen::Vector3d& p : points) inside += box.holds(view.pixel(p)) ? 1U : 0U;
    EXPECT_GT(static_cast<double>(inside), 0.99 * static_cast<double>(points.size()));
  }
}

}  // namespace
}  // namespace arris::report
