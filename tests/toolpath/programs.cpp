#include "tests/toolpath/programs.hpp"

#include <cmath>
#include <random>

namespace arris::test {
namespace {

// Any rotation, every kind of awkward one among them: none, tiny, half turns, about and near the axes.
Eigen::Matrix3d awkward_rotation(std::mt19937_64& random, int i) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double kPi = 3.141592653589793;
  const Eigen::Vector3d any = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  const Eigen::Vector3d axis = i % 3 == 0 ? Eigen::Vector3d(Eigen::Vector3d::Unit(i % 9 / 3)) : any;
  switch (i % 8) {
    case 0:
      return Eigen::Matrix3d::Identity();
    case 1:
      return Eigen::AngleAxisd(kPi, axis).toRotationMatrix();  // half turn
    case 2:
      return Eigen::AngleAxisd(kPi + 1e-7 * uniform(random), axis).toRotationMatrix();  // nearly one
    case 3:
      return Eigen::AngleAxisd(0.5 * kPi * (i % 5), axis).toRotationMatrix();  // quarter turns
    case 4:
      return (Eigen::AngleAxisd(kPi * uniform(random), Eigen::Vector3d::UnitZ()) *  // gimbal lock
              Eigen::AngleAxisd(0.5 * kPi, Eigen::Vector3d::UnitY()) *
              Eigen::AngleAxisd(kPi * uniform(random), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
    case 6: {  // and about z, as tools stand on flat parts: upright or upside down, or nearly
      const double tilt = (i % 16 < 8 ? 0.0 : kPi) + (i % 3 == 0 ? 0.0 : std::pow(10.0, -3 - i % 7));
      return (Eigen::AngleAxisd(kPi * uniform(random), Eigen::Vector3d::UnitZ()) *
              Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()) *
              Eigen::AngleAxisd(kPi * uniform(random), Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
    }
    case 5:
      return Eigen::AngleAxisd(1e-6 * uniform(random), axis).toRotationMatrix();  // next to none
    default:
      return Eigen::AngleAxisd(kPi * uniform(random), any).toRotationMatrix();
  }
}

}  // namespace

std::string toy_hash(std::string_view text) {
  std::string hex;
  for (std::uint64_t round = 0; round < 4; ++round) {
    std::uint64_t hash = 14695981039346656037ull + round;
    for (char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    for (int shift = 60; shift >= 0; shift -= 4) hex += "0123456789abcdef"[(hash >> shift) & 15u];
  }
  return hex;
}

Cell some_cell(const std::string& controller) {
  Cell cell;
  if (controller == "vplus") {
    cell.spindle_output = "97";
    cell.spindle_ready = "1097";
  }
  cell.robot_from_scan.translation() << 850.0, -120.5, 400.25;
  cell.robot_from_scan.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.2, -0.3, 1.0).normalized()).toRotationMatrix();
  cell.robot_from_work.translation() << 800.0, -100.0, 390.0;
  cell.robot_from_work.linear() = Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  cell.flange_from_tool.translation() << 12.5, 0.0, 180.25;
  cell.flange_from_tool.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()).toRotationMatrix();
  cell.tool_mass_kg = 2.5;
  return cell;
}

Correction ring(int rows, double radius_mm, bool closed, int path) {
  Correction correction;
  for (int i = 0; i < rows; ++i) {
    const double angle = 6.283185307179586 * i / rows;
    CorrectedPoint row;
    row.point.tip_mm << radius_mm * std::cos(angle), radius_mm * std::sin(angle), 3.0 * std::sin(2.0 * angle);
    row.point.axis = Eigen::Vector3d(0.2 * std::cos(angle), 0.2 * std::sin(angle), 1.0).normalized();
    row.point.path = path;
    row.point.closed = closed;
    row.has_place = true;
    correction.points.push_back(row);
  }
  return correction;
}

Program random_program(std::uint64_t seed, int moves, const std::string& controller) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Program program;
  program.cell = some_cell(controller);
  program.name = program.cell.program_name;
  program.result_hash = toy_hash("result");
  program.comments = {"Arris test", "part A-1042"};
  const double speeds_mm_s[] = {200.0, 20.0, 12.345, 0.5}, zones_mm[] = {0.0, 0.3, 0.15, 0.0375};
  for (int i = 0; i < moves; ++i) {
    Move move;
    move.work_from_tool.linear() = awkward_rotation(random, i);
    for (int k = 0; k < 3; ++k) move.work_from_tool.translation()[k] = 2500.0 * uniform(random);
    if (i % 50 == 7) move.work_from_tool.translation() *= 1e-6;  // would be written as -0.0000
    move.speed_mm_s = speeds_mm_s[random() % 4];
    move.zone_mm = zones_mm[random() % 4];
    move.joint = random() % 10 == 0;
    if (i % 97 == 3 || i % 331 == 5 || i + 1 == moves) move.zone_mm = 0.0;
    program.events.emplace_back(move);
    if (i % 97 == 3) program.events.emplace_back(SetOutput{program.cell.spindle_output, random() % 2 == 0});
    if (i % 331 == 5)
      program.events.emplace_back(
          WaitInput{program.cell.spindle_ready, random() % 2 == 0, 5.0, program.cell.spindle_output});
  }
  program.events.emplace_back(SetOutput{program.cell.spindle_output, false});
  return program;
}

}  // namespace arris::test
