#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "fixtures/synthetic/part.hpp"
#include "registration/scene.hpp"

namespace arris::bench {

/// A part whose pose is searched, with the contours that its tool path runs round.
struct PosePart {
  std::string name;
  std::unique_ptr<const synthetic::Part> shape;
  std::vector<int> followed;  ///< contours of the shape; the path runs round each
  bool whole_face = false;    ///< scanned as far as its outline; else the usual band round the opening
  CadModel cad;

  /// Of the followed contours: largest length / (2 pi); mm.
  [[nodiscard]] double size_mm() const;
};

/// The finite element parts in a folder, in order of their names, then the synthetic plates.
[[nodiscard]] std::vector<PosePart> pose_parts(const std::filesystem::path& fixtures);

}  // namespace arris::bench
