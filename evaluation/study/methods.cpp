// SPDX-License-Identifier: MIT
#include "evaluation/study/methods.h"

#include <fmt/core.h>

namespace sheen::evaluation {

using fitting::iwls::Construction;

std::unique_ptr<fitting::PatchFitter> Method::make(std::size_t patch_count) const {
  return fitting::make_isolated_patches(representation, patch_count, options);
}

Method iwls_method(Construction construction, bool faithful, int centers, int terms,
                   fitting::iwls::Layout layout) {
  const std::string name = fmt::format("{} {}x{} {}", name_of(construction), centers, terms,
                                       faithful ? "faithful" : "ridge");
  return {name,
          "iwls",
          {{"fitter", std::string(name_of(construction))},
           {"layout", std::string(name_of(layout))},
           {"centers", std::to_string(centers)},
           {"terms", terms == 0 ? "auto" : std::to_string(terms)},
           {"faithful", faithful ? "true" : "false"}}};
}

Method harmonics_method(int degree) {
  return {fmt::format("sh {}", degree), "sh", {{"degree", std::to_string(degree)}}};
}

Method free_harmonics_method() {
  return {"sh 3 ridge .01", "sh", {{"ridge", "0.01"}}};
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
  methods.push_back({"mean", "mean"});
  for (int degree = 1; degree <= 3; ++degree) methods.push_back(harmonics_method(degree));
  methods.push_back(free_harmonics_method());
  methods.push_back({"sparse", "sparse"});
  methods.push_back({"nearest-views", "nearest-views"});
  return methods;
}

}  // namespace sheen::evaluation
