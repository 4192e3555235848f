#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "fixtures/synthetic/part.hpp"

namespace arris::bench {

/// A part of the study, drawn by its seed: its shape, how it bends, the kind of noise of its scans.
struct StudyPart {
  std::unique_ptr<synthetic::Part> part;
  std::string kind;              ///< "smooth", "dent", "crease", or the finite element part's name
  double noise_length_mm = 0.0;  ///< half of the scans carry noise correlated over this; 0: white
};

/// One in three bends in a way that no smooth field of the method's node spacing is: dents, creases, finite
/// element parts. The others are bent to a cylinder, twisted and stretched evenly. Seeds in different
/// hundreds share nothing.
[[nodiscard]] StudyPart study_part(std::uint64_t seed, const std::filesystem::path& fe_folder);

}  // namespace arris::bench
