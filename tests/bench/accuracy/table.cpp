#include "tests/bench/accuracy/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace arris::bench {
namespace {

const char* label(Method method) {
  switch (method) {
    case kNominal:
      return "nominal path, true pose";
    case kBestRigid:
      return "best rigid motion there is";
    case kRigidIcp:
      return "rigid ICP, the best of four";
    case kOursToPoint:
      return "ours, point to point";
    case kOursToPlane:
      return "ours, point to plane";
    case kPclToPoint:
      return "PCL, point to point";
    case kPclToPlane:
      return "PCL, point to plane";
    case kParabola:
      return "projection, parabola";
    case kHeightSpline:
      return "projection, spline";
    case kPaper:
      return "subdivision ICP, the paper's choices";
    case kPaperNoSupport:
      return "the same, without stability points";
    case kPlain:
      return "our subdivision ICP, edge as extracted";
    case kSupported:
      return "our subdivision ICP, edge by support";
    case kRefined:
      return "our subdivision ICP, edge by support, joint fit";
    default:
      return "**the whole method**";
  }
}

std::string percent(double ratio) {
  return std::isfinite(ratio) ? fmt::format("{:+.0f} %", 100.0 * ratio) : "-";
}

std::string row_text(const CaseResult& result, Method method) {
  const Summary s = summary(result, method);
  if (s.count == 0) return fmt::format("| {} | - | - | - | - | - | - | - | - | - | - |\n", label(method));
  return fmt::format(
      "| {} | {:.3f} ({:.3f}) | {:.3f} ({:.3f}) | {:.3f} | {:.3f} | {} | {} | {} | {} | {} |\n",
      label(method), s.mean_mm, s.worst_mean_mm, s.max_mm, s.worst_max_mm, s.normal_mm, s.across_mm,
      result.along_free ? "free" : fmt::format("{:.2f}", s.along_mm),
      percent(change(result, method, kRigidIcp, false)), percent(change(result, method, kRigidIcp, true)),
      percent(change(result, method, kBestRigid, false)), s.count);
}

double mean_of(const CaseResult& result, double Outcome::*member) {
  double sum = 0.0;
  for (const Outcome& outcome : result.seeds) sum += outcome.*member;
  return sum / static_cast<double>(result.seeds.size());
}

std::size_t refusals(const CaseResult& result) {
  return static_cast<std::size_t>(std::count_if(result.seeds.begin(), result.seeds.end(),
                                                [](const Outcome& o) { return !o.reasons.empty(); }));
}

/// Refused seeds, each with its first reason and what the refused path would have been off by.
std::string refusal_lines(const CaseResult& result) {
  std::string text;
  for (std::size_t i = 0; i < result.seeds.size(); ++i) {
    const Outcome& outcome = result.seeds[i];
    if (outcome.reasons.empty()) continue;
    text += fmt::format("- {}, {}, seed {}: {}", result.part, result.scan, i + 1, outcome.reasons.front());
    if (outcome.refused)
      text += fmt::format(" (it would have been off by {:.2f} mm, at most {:.2f})", outcome.refused->mean_mm,
                          outcome.refused->max_mm);
    text += "\n";
  }
  return text;
}

const CaseResult* usual(const std::vector<CaseResult>& results, const std::string& part) {
  for (const CaseResult& result : results)
    if (result.part == part && result.goal == Goal::kUsual) return &result;
  return nullptr;
}

std::string goal_row(const std::string& what, const std::string& paper, const std::string& goal,
                     const std::string& reached, bool met) {
  return fmt::format("| {} | {} | {} | {} | {} |\n", what, paper, goal, reached, met ? "met" : "**missed**");
}

}  // namespace

Summary summary(const CaseResult& result, Method method) {
  Summary s;
  for (const Outcome& outcome : result.seeds) {
    if (!outcome.error[method]) continue;
    const PathError& e = *outcome.error[method];
    ++s.count;
    s.mean_mm += e.mean_mm;
    s.max_mm += e.max_mm;
    s.normal_mm += e.normal_mm;
    s.across_mm += e.across_mm;
    s.along_mm += e.along_mm;
    s.worst_mean_mm = std::max(s.worst_mean_mm, e.mean_mm);
    s.worst_max_mm = std::max(s.worst_max_mm, e.max_mm);
  }
  for (double* sum : {&s.mean_mm, &s.max_mm, &s.normal_mm, &s.across_mm, &s.along_mm})
    *sum /= static_cast<double>(std::max<std::size_t>(1, s.count));
  return s;
}

double change(const CaseResult& result, Method method, Method base, bool peak) {
  double ours = 0.0, theirs = 0.0;
  for (const Outcome& outcome : result.seeds) {
    if (!outcome.error[method] || !outcome.error[base]) continue;
    ours += peak ? outcome.error[method]->max_mm : outcome.error[method]->mean_mm;
    theirs += peak ? outcome.error[base]->max_mm : outcome.error[base]->mean_mm;
  }
  return theirs > 0.0 ? ours / theirs - 1.0 : std::numeric_limits<double>::quiet_NaN();
}

std::string overview_table(const std::vector<CaseResult>& results) {
  std::string text =
      "| part | scan | points | mean (worst) | max (worst) | normal | across | E | sigma/sqrt(n) | "
      "mean against rigid ICP | peak | mean against best rigid | refused |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const CaseResult& r : results) {
    const Summary s = summary(r, kWhole);
    if (s.count == 0) continue;  // all refused: the list of refusals names them
    text += fmt::format(
        "| {} | {} | {} | {:.3f} ({:.3f}) | {:.3f} ({:.3f}) | {:.3f} | {:.3f} | {:.2f} | {:.3f} | {} | {} | "
        "{} | {} of {} |\n",
        r.part, r.scan, r.seeds.front().points, s.mean_mm, s.worst_mean_mm, s.max_mm, s.worst_max_mm,
        s.normal_mm, s.across_mm, mean_of(r, &Outcome::edge_limit_mm), mean_of(r, &Outcome::surface_limit_mm),
        percent(change(r, kWhole, kRigidIcp, false)), percent(change(r, kWhole, kRigidIcp, true)),
        percent(change(r, kWhole, kBestRigid, false)), refusals(r), r.seeds.size());
  }
  return text;
}

std::string case_table(const CaseResult& result) {
  std::string text = fmt::format("#### {}, {}\n\n", result.part, result.scan);
  text +=
      "| | mean (worst) | max (worst) | normal | across | along | mean against rigid ICP | peak against "
      "rigid ICP | "
      "mean against best rigid | seeds |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Method method : {kNominal, kBestRigid, kRigidIcp, kParabola, kHeightSpline, kPaper,
                              kPaperNoSupport, kPlain, kSupported, kRefined, kWhole})
    text += row_text(result, method);
  return text;
}

std::string refusal_list(const std::vector<CaseResult>& results) {
  std::string text;
  for (const CaseResult& result : results) text += refusal_lines(result);
  return text.empty() ? "None was refused.\n" : text;
}

std::string rigid_table(const std::vector<CaseResult>& results) {
  const auto methods = {kOursToPoint, kOursToPlane, kPclToPoint, kPclToPlane};
  std::string text = "| part | scan |", line = "|---|---|";
  for (const Method method : methods) {
    text += fmt::format(" {} |", label(method));
    line += "---|";
  }
  text += "\n" + line + "\n";
  for (const CaseResult& r : results) {
    if (!r.every_method) continue;
    text += fmt::format("| {} | {} |", r.part, r.scan);
    for (const Method method : methods) {
      const Summary s = summary(r, method);
      const auto wins = std::count_if(r.seeds.begin(), r.seeds.end(), [&](const Outcome& o) {
        return o.error[kRigidIcp] && o.rigid_winner == method;
      });
      text += fmt::format(" {:.2f} / {:.2f}, best {} times |", s.mean_mm, s.max_mm, wins);
    }
    text += "\n";
  }
  return text;
}

std::string target_table(const std::vector<CaseResult>& results) {
  std::string text = "| goal (usual scan) | paper | goal | reached | |\n|---|---|---|---|---|\n";
  if (const CaseResult* nose = usual(results, "nosecone")) {
    const double mean = change(*nose, kWhole, kRigidIcp, false),
                 peak = change(*nose, kWhole, kRigidIcp, true);
    text += goal_row("nose cone, mean error against rigid ICP", "-57 %", "-75 % or better", percent(mean),
                     mean <= -0.75);
    text += goal_row("nose cone, peak error against rigid ICP", "-45 %", "-65 % or better", percent(peak),
                     peak <= -0.65);
  }
  if (const CaseResult* porthole = usual(results, "porthole")) {
    for (const Method method : {kParabola, kHeightSpline}) {
      const double left = 1.0 + change(*porthole, method, kRigidIcp, false);
      text +=
          goal_row(fmt::format("porthole, 1,500 points: {}, mean error left of rigid ICP's", label(method)),
                   "65 %", "65 % or less", fmt::format("{:.0f} %", 100.0 * left), left <= 0.65);
    }
  }
  if (const CaseResult* sheet = usual(results, "sheet")) {
    const Summary s = summary(*sheet, kWhole);
    text += goal_row("sheet, circular contour, mean error", "about 0.2 mm", "0.4 mm or less",
                     fmt::format("{:.3f} mm, max {:.3f}", s.mean_mm, s.worst_max_mm),
                     s.count > 0 && s.mean_mm <= 0.4);
  }
  return text;
}

}  // namespace arris::bench
