// SPDX-License-Identifier: MIT
#include "fitting/registry.h"

#include "fitting/iwls/iwls_fitter.h"
#include "fitting/iwls/model_codec.h"
#include "fitting/mean/mean_fitter.h"
#include "fitting/mean/model_codec.h"
#include "fitting/model_file/model_codec.h"
#include "fitting/nearest_views/model_codec.h"
#include "fitting/nearest_views/nearest_fitter.h"
#include "fitting/sparse/model_codec.h"
#include "fitting/sparse/sparse_fitter.h"
#include "fitting/spherical_harmonics/harmonics_fitter.h"
#include "fitting/spherical_harmonics/model_codec.h"

#include <array>
#include <stdexcept>

namespace sheen::fitting {
namespace {

using Neighbours = core::VertexNeighbours;

std::unique_ptr<Fitter> make_iwls(const Neighbours& neighbours, const FitOptions& options) {
  return iwls::make_iwls_fitter(neighbours, options.iwls, options.threads);
}

std::unique_ptr<Fitter> make_mean(const Neighbours& neighbours, const FitOptions& options) {
  return mean::make_mean_fitter(neighbours, options.threads);
}

std::unique_ptr<Fitter> make_harmonics(const Neighbours& neighbours, const FitOptions& options) {
  return spherical_harmonics::make_harmonics_fitter(neighbours, options.spherical_harmonics,
                                                    options.threads);
}

std::unique_ptr<Fitter> make_nearest_views(const Neighbours& neighbours,
                                           const FitOptions& options) {
  return nearest_views::make_nearest_fitter(neighbours, options.threads);
}

std::unique_ptr<Fitter> make_sparse(const Neighbours& neighbours, const FitOptions& options) {
  return sparse::make_sparse_fitter(neighbours, options.sparse, options.threads);
}

struct Entry {
  const char* name;
  std::unique_ptr<Fitter> (*make)(const Neighbours&, const FitOptions&);
};

constexpr std::array kRepresentations{Entry{"iwls", make_iwls}, Entry{"mean", make_mean},
                                      Entry{"sh", make_harmonics}, Entry{"sparse", make_sparse},
                                      Entry{"nearest-views", make_nearest_views}};

constexpr std::array kCodecs{
    ModelCodec{"iwls", iwls::encode_model, iwls::decode_model},
    ModelCodec{"mean", mean::encode_model, mean::decode_model},
    ModelCodec{"nearest-views", nearest_views::encode_model, nearest_views::decode_model},
    ModelCodec{"sh", spherical_harmonics::encode_model, spherical_harmonics::decode_model},
    ModelCodec{"sparse", sparse::encode_model, sparse::decode_model}};

}  // namespace

std::vector<std::string> representation_names() {
  std::vector<std::string> names;
  for (const Entry& entry : kRepresentations) names.emplace_back(entry.name);
  return names;
}

std::unique_ptr<Fitter> make_fitter(const std::string& name, const Neighbours& neighbours,
                                    const FitOptions& options) {
  if (options.threads < 1) {
    throw std::invalid_argument("threads is " + std::to_string(options.threads) +
                                ", at least 1 is needed");
  }
  std::string known;
  for (const Entry& entry : kRepresentations) {
    if (name == entry.name) return entry.make(neighbours, options);
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw std::invalid_argument("representation \"" + name + "\" is unknown, there are: " + known);
}

std::span<const ModelCodec> model_codecs() {
  return kCodecs;
}

}  // namespace sheen::fitting
