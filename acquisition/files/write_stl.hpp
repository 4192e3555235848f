#pragma once

#include <ostream>
#include <string>

#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// Writes binary STL: coordinates in mm as float32 (the format has no other), facet normals from the corners.
///   title    at most 60 characters of it stand in the header, behind a front that is never "solid"
///   throws   Error(kBug) when a triangle has an index outside the vertices
void write_stl(std::ostream& out, const TriangleMesh& mesh, const std::string& title = {});

}  // namespace arris
