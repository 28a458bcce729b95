// SPDX-License-Identifier: MIT
#include "app/comparison/candidates.h"

#include <algorithm>

namespace sheen::app {
namespace {

using Options = fitting::FitOptions;
using Construction = fitting::iwls::Construction;

constexpr const char* kSimple = "Simple baselines";
constexpr const char* kHarmonics = "Spherical harmonics";
constexpr const char* kPaper = "IWLS as published";
constexpr const char* kRidge = "IWLS with ridge";
constexpr const char* kSparse = "Sparse";

void as_it_is(Options&) {}

template <int kDegree>
void degree(Options& options) {
  options.spherical_harmonics.degree = kDegree;
}

template <Construction kConstruction>
void faithful(Options& options) {
  options.iwls.construction = kConstruction;
  options.iwls.faithful = true;
}

template <Construction kConstruction>
void ridge(Options& options) {
  options.iwls.construction = kConstruction;
}

template <int kThousandths>
void tolerance(Options& options) {
  options.sparse.tolerance = kThousandths / 1000.0f;
}

/// One line each; a representation that is not registered takes its candidates off the list.
constexpr Candidate kCandidates[] = {
    {"mean", "mean colour", kSimple, "mean", as_it_is},
    {"nearest-views", "nearest views", kSimple, "nearest-views", as_it_is},
    {"sh1", "harmonics 1", kHarmonics, "sh", degree<1>},
    {"sh2", "harmonics 2", kHarmonics, "sh", degree<2>},
    {"sh3", "harmonics 3", kHarmonics, "sh", degree<3>},
    {"paper-quadtree", "paper, quadtree", kPaper, "iwls", faithful<Construction::quadtree>},
    {"paper-adaptive", "paper, adaptive", kPaper, "iwls", faithful<Construction::adaptive>},
    {"quadtree", "quadtree, ridge", kRidge, "iwls", ridge<Construction::quadtree>},
    {"batch", "batch, ridge", kRidge, "iwls", ridge<Construction::batch>},
    {"sparse-0.04", "sparse 0.04", kSparse, "sparse", tolerance<40>},
    {"sparse", "sparse", kSparse, "sparse", as_it_is},
    {"sparse-0.01", "sparse 0.01", kSparse, "sparse", tolerance<10>},
    {"sparse-0.005", "sparse 0.005", kSparse, "sparse", tolerance<5>},
};

bool is_among(const std::vector<std::string>& names, const char* name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<Candidate> all_candidates() {
  const std::vector<std::string> registered = fitting::representation_names();
  std::vector<Candidate> candidates;
  for (const Candidate& candidate : kCandidates) {
    if (is_among(registered, candidate.representation)) candidates.push_back(candidate);
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

std::unique_ptr<fitting::Fitter> make_fitter(const Candidate& candidate,
                                             const core::VertexNeighbours& neighbours,
                                             int threads) {
  Options options;
  options.threads = threads;
  candidate.choose(options);
  return fitting::make_fitter(candidate.representation, neighbours, options);
}

}  // namespace sheen::app
