#include "registration/surface_stage.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace arris {
namespace {

// A slot that slid is refused through the real program: SlidSlot.IsRefusedOrRight.
TEST(Slide, OneSmallerThanTheLeastIsNoRefusalAndALargerOneIs) {
  for (const double spacing_mm : {0.3, 2.0, 4.0, 7.0}) {
    const double least_mm = std::max(4.0, 1.5 * spacing_mm);
    EXPECT_FALSE(is_slide(0.0, spacing_mm));
    EXPECT_FALSE(is_slide(2.0, spacing_mm));  // of the search: one step, within what rows of points show
    EXPECT_FALSE(is_slide(std::nextafter(least_mm, 0.0), spacing_mm));
    EXPECT_TRUE(is_slide(least_mm, spacing_mm));
    EXPECT_TRUE(is_slide(12.0, spacing_mm));
  }
}

}  // namespace
}  // namespace arris
