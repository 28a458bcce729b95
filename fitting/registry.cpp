// SPDX-License-Identifier: MIT
#include "fitting/billboard/descriptor.h"
#include "fitting/depth_quads/descriptor.h"
#include "fitting/descriptor.h"
#include "fitting/detail/descriptor.h"
#include "fitting/eigen_texture/descriptor.h"
#include "fitting/iwls/descriptor.h"
#include "fitting/mean/descriptor.h"
#include "fitting/multi_eigenspace/descriptor.h"
#include "fitting/nearest_views/descriptor.h"
#include "fitting/sparse/descriptor.h"
#include "fitting/spherical_harmonics/descriptor.h"
#include "fitting/view_dependent_texture/descriptor.h"

#include <algorithm>
#include <stdexcept>

namespace sheen::fitting {
namespace {

/// One line per representation; the first is the default.
std::vector<const Descriptor*>& registry() {
  static std::vector<const Descriptor*> all{
      &detail::kDescriptor,        &sparse::kDescriptor,
      &iwls::kDescriptor,          &spherical_harmonics::kDescriptor,
      &mean::kDescriptor,          &nearest_views::kDescriptor,
      &depth_quads::kDescriptor,   &view_dependent_texture::kDescriptor,
      &billboard::kDescriptor,     &multi_eigenspace::kDescriptor,
      &eigen_texture::kDescriptor,
  };
  return all;
}

const Descriptor* find(std::string_view name) {
  const auto& all = registry();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Descriptor* one) { return one->name == name; });
  return found == all.end() ? nullptr : *found;
}

}  // namespace

std::vector<const Descriptor*> representations() {
  return registry();
}

const Descriptor& representation_named(std::string_view name) {
  if (const Descriptor* const found = find(name)) return *found;
  std::string known;
  for (const Descriptor* one : registry()) {
    known += (known.empty() ? "" : ", ") + std::string(one->name);
  }
  throw std::invalid_argument("representation \"" + std::string(name) +
                              "\" is unknown, there are: " + known);
}

void register_representation(const Descriptor& descriptor) {
  if (find(descriptor.name) != nullptr) {
    throw std::invalid_argument("representation \"" + std::string(descriptor.name) +
                                "\" exists already");
  }
  registry().push_back(&descriptor);
}

std::unique_ptr<FitOptions> options_from(const Descriptor& descriptor, const OptionValues& values) {
  auto options = descriptor.default_options();
  apply(values, descriptor.name, options->table());
  options->check();
  return options;
}

std::unique_ptr<Fitter> make_fitter(std::string_view representation, const core::Mesh& mesh,
                                    const OptionValues& values, int threads) {
  if (threads < 1) {
    throw std::invalid_argument("threads is " + std::to_string(threads) + ", at least 1 is needed");
  }
  const Descriptor& descriptor = representation_named(representation);
  return descriptor.make(mesh, *options_from(descriptor, values), threads);
}

}  // namespace sheen::fitting
