// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/model_file/model_file.h"

#include <Eigen/Geometry>

#include <array>
#include <string>
#include <vector>

namespace sheen::exporters {

/// A Gaussian with a colour that depends on the direction, in the conventions of "3D Gaussian
/// Splatting" (Kerbl et al., 2023) and its reference implementation.
struct Splat {
  Eigen::Vector3f position;                   ///< metres
  Eigen::Quaternionf rotation;                ///< unit; axes of the Gaussian
  Eigen::Vector3f sigma;                      ///< along them, metres, > 0
  float opacity = 0;                          ///< of its centre, (0, 1)
  std::array<Eigen::Vector3f, 16> harmonics;  ///< [l, m = -l ... l], r g b

  /// sRGB, before the limits of the display; `direction` is a unit vector from the camera to the
  /// splat.
  [[nodiscard]] Eigen::Vector3f colour(const Eigen::Vector3f& direction) const;
  /// The same over all directions, in [0, 1].
  [[nodiscard]] Eigen::Vector3f mean_colour() const;
};

struct Splats {
  std::vector<Splat> splats;
  std::vector<std::uint32_t> vertex;  ///< of the mesh that each stands for
  Eigen::Vector3d offset{0, 0, 0};    ///< core::Mesh::offset, in the axes of the splats
};

/// A flat disc for every vertex that a triangle uses, as wide as its edges are long to either side,
/// with harmonics of degree 0 to 3 that are nearest to the model's radiance over the hemisphere it
/// can be seen from; towards the other, harmonics are held near the mean, since they would swing
/// there. Axes are those of `axes_from_object`, a rotation. Throws core::Error (bad_input) for
/// models without patches.
Splats make_splats(const fitting::Model& model, const Eigen::Matrix3f& axes_from_object);

/// What a reader of the splats sees, drawn on the mesh: harmonics in place of the patches. What
/// is lost between the discs is not in it.
fitting::Model splat_model(const fitting::Model& model, const Splats& splats,
                           const Eigen::Matrix3f& axes_from_object);

/// What the user should know about splats of this model.
std::vector<std::string> splat_remarks(const fitting::Model& model);

}  // namespace sheen::exporters
