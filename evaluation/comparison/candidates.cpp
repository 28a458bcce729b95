// SPDX-License-Identifier: MIT
#include "evaluation/comparison/candidates.h"

#include "fitting/descriptor.h"

#include <algorithm>

namespace sheen::evaluation {
namespace {

constexpr const char* kSimple = "Simple baselines";
constexpr const char* kHarmonics = "Spherical harmonics";
constexpr const char* kPaper = "IWLS as published";
constexpr const char* kRidge = "IWLS with ridge";
constexpr const char* kSparse = "Sparse";
constexpr const char* kTexture = "Sparse with a texture";

/// One line each.
std::vector<Candidate> known_candidates() {
  return {
      {"mean", "mean colour", kSimple, "mean"},
      {"nearest-views", "nearest views", kSimple, "nearest-views"},
      {"sh1", "harmonics 1", kHarmonics, "sh", {{"degree", "1"}}},
      {"sh2", "harmonics 2", kHarmonics, "sh", {{"degree", "2"}}},
      {"sh3", "harmonics 3", kHarmonics, "sh", {{"degree", "3"}}},
      {"paper-quadtree", "paper, quadtree", kPaper, "iwls", {{"faithful", "true"}}},
      {"paper-adaptive",
       "paper, adaptive",
       kPaper,
       "iwls",
       {{"faithful", "true"}, {"fitter", "adaptive"}}},
      {"quadtree", "quadtree, ridge", kRidge, "iwls"},
      {"batch", "batch, ridge", kRidge, "iwls", {{"fitter", "batch"}}},
      {"sparse-0.04", "sparse 0.04", kSparse, "sparse", {{"tolerance", "0.04"}}},
      {"sparse", "sparse", kSparse, "sparse"},
      {"sparse-0.01", "sparse 0.01", kSparse, "sparse", {{"tolerance", "0.01"}}},
      {"sparse-0.005", "sparse 0.005", kSparse, "sparse", {{"tolerance", "0.005"}}},
      {"detail", "detail texture", kTexture, "detail", {{"offsets", "vertex"}}},
      {"detail-anchors", "detail texture, anchors", kTexture, "detail", {{"offsets", "anchors"}}},
  };
}

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<Candidate> all_candidates() {
  std::vector<Candidate> candidates = known_candidates();
  for (const fitting::Descriptor* descriptor : fitting::representations()) {
    const std::string name(descriptor->name);
    const bool is_known = std::ranges::any_of(
        candidates, [&](const Candidate& candidate) { return candidate.representation == name; });
    if (!is_known) candidates.push_back({name, name, "Others", name});
  }
  return candidates;
}

std::vector<Candidate> candidates_named(const std::vector<std::string>& names) {
  std::vector<Candidate> candidates = all_candidates();
  if (names.empty()) return candidates;
  std::erase_if(candidates, [&](const Candidate& c) { return !is_among(names, c.name); });
  return candidates;
}

std::vector<std::string> candidate_names() {
  std::vector<std::string> names;
  for (const Candidate& candidate : all_candidates()) names.emplace_back(candidate.name);
  return names;
}

}  // namespace sheen::evaluation
