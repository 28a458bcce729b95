// SPDX-License-Identifier: MIT
#include "bench/study/methods.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

namespace sheen::bench {

using fitting::iwls::Construction;

std::unique_ptr<fitting::Fitter> Method::make(std::size_t patch_count) const {
  core::VertexNeighbours neighbours;
  neighbours.offsets.assign(patch_count + 1, 0);
  return fitting::make_fitter(representation, neighbours, options);
}

Method iwls_method(Construction construction, bool faithful, int centers, int terms,
                   fitting::iwls::Layout layout) {
  fitting::FitOptions options;
  options.iwls.construction = construction;
  options.iwls.faithful = faithful;
  options.iwls.centers = centers;
  options.iwls.terms = terms;
  options.iwls.layout = layout;
  const std::string name = fmt::format("{} {}x{} {}", name_of(construction), centers, terms,
                                       faithful ? "faithful" : "ridge");
  return {name, "iwls", options};
}

Method harmonics_method(int degree) {
  fitting::FitOptions options;
  options.spherical_harmonics.degree = degree;
  return {fmt::format("sh {}", degree), "sh", options};
}

Method free_harmonics_method() {
  Method method = harmonics_method(3);
  method.name = "sh 3 ridge .01";
  method.options.spherical_harmonics.ridge = 0.01;
  return method;
}

std::vector<Method> all_methods() {
  std::vector<Method> methods;
  for (const bool faithful : {true, false}) {
    for (const Construction construction :
         {Construction::quadtree, Construction::adaptive, Construction::batch}) {
      methods.push_back(iwls_method(construction, faithful));
    }
  }
  methods.push_back(iwls_method(Construction::quadtree, false, 64));
  methods.push_back(iwls_method(Construction::batch, false, 16, 1));
  methods.push_back(iwls_method(Construction::batch, false, 16, 6));
  for (const std::string& name : fitting::representation_names()) {
    if (name == "sh") {
      for (int degree = 1; degree <= 3; ++degree) methods.push_back(harmonics_method(degree));
      methods.push_back(free_harmonics_method());
    } else if (name != "iwls") {
      methods.push_back({name, name, {}});
    }
  }
  return methods;
}

std::string default_method_name() {
  const std::vector<std::string> names = fitting::representation_names();
  const bool has_sparse = std::find(names.begin(), names.end(), "sparse") != names.end();
  return has_sparse ? "sparse" : iwls_method(Construction::quadtree, false).name;
}

}  // namespace sheen::bench
