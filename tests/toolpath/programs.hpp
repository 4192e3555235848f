#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "toolpath/robot/program.hpp"

namespace arris::test {

/// A stand-in for SHA-256 with the same shape: FNV-1a, 64 bits, four times over.
[[nodiscard]] std::string toy_hash(std::string_view text);

/// A station whose frames all differ from the identity; its lines are called as `controller` (a word of
/// robot.controller) calls them.
[[nodiscard]] Cell some_cell(const std::string& controller = "rapid");

/// An accepted correction: a ring of rows with leaning axes, closed or not, as polyline `path`.
[[nodiscard]] Correction ring(int rows, double radius_mm, bool closed, int path = 1);

/// A program of random moves, awkward rotations among them (none, tiny, quarter and half turns, gimbal lock
/// about y and about z, and near it), with outputs and waits strewn in, each behind a move that stops.
[[nodiscard]] Program random_program(std::uint64_t seed, int moves, const std::string& controller = "rapid");

}  // namespace arris::test
