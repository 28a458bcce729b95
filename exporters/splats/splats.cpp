// SPDX-License-Identifier: MIT
#include "exporters/splats/splats.h"

#include "core/geometry/disc_map.h"
#include "core/geometry/tangent_frame.h"
#include "core/mesh/neighbours.h"
#include "fitting/patch_light_field.h"
#include "fitting/spherical_harmonics/basis.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <optional>
#include <utility>

namespace sheen::exporters {
namespace {

constexpr std::size_t kTerms = 16;
using Row = Eigen::Matrix<double, kTerms, 1>;

// Where pictures of splats are nearest to those of the mesh: measured in the reference renderer for
// widths of 0.4 to 1.3 edges and opacities of 0.9 and 0.99, where 0.5 to 0.6 was best with either.
constexpr float kSigmaPerEdge = 0.55f;
constexpr float kOpacity = 0.95f;
constexpr float kThickness = 0.05f;  // of a disc, of its width
constexpr float kNarrowest = 0.2f;   // its shorter axis, of the longer one

// Directions over the hemisphere, even on the disc as pixels see them: side of their square.
constexpr int kSide = 8;
constexpr double kBelowWeight = 0.05;  // of a direction that the patch is hidden from

/// Reference order and signs: those of (-1)^m times the orthonormal functions without them.
Row harmonics_of(const Eigen::Vector3f& direction) {
  const Eigen::Vector3d d = direction.cast<double>();
  const auto plain = fitting::spherical_harmonics::basis<kTerms>(d.x(), d.y(), d.z());
  Row row;
  std::size_t term = 0;
  for (int degree = 0; degree <= 3; ++degree) {
    for (int order = -degree; order <= degree; ++order, ++term) {
      row[static_cast<Eigen::Index>(term)] = order % 2 == 0 ? plain[term] : -plain[term];
    }
  }
  return row;
}

/// Places on the unit disc, spread evenly.
std::vector<Eigen::Vector2f> disc_places() {
  std::vector<Eigen::Vector2f> places;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Eigen::Vector2f cell(static_cast<float>(i % kSide), static_cast<float>(i / kSide));
    const Eigen::Vector2f square = (2.0f * cell.array() + 1.0f) / kSide - 1.0f;
    places.push_back(core::disc_from_square(square));
  }
  return places;
}

/// Weighted least squares over both hemispheres.
std::array<Eigen::Vector3f, kTerms> fit_harmonics(const fitting::PatchLightField& patches,
                                                  std::size_t patch,
                                                  const core::TangentFrame& frame,
                                                  const Eigen::Matrix3f& axes,
                                                  const std::vector<Eigen::Vector2f>& places) {
  Eigen::Matrix<double, kTerms, kTerms> squares = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Eigen::Matrix<double, kTerms, 3> products = Eigen::Matrix<double, kTerms, 3>::Zero();
  const auto add = [&](const Eigen::Vector3f& towards_eye, const Eigen::Vector3f& colour,
                       double weight) {
    const Row row = harmonics_of(-(axes * towards_eye));
    squares.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    products += weight * row * (colour.array() - 0.5f).matrix().cast<double>().transpose();
  };
  const Eigen::Vector3f mean = patches.mean_colour(patch).cwiseMax(0.0f).cwiseMin(1.0f);
  for (const Eigen::Vector2f& uv : places) {
    const Eigen::Vector3f local = core::hemisphere_from_disc(uv);
    const Eigen::Vector3f level = local.x() * frame.tangent + local.y() * frame.bitangent;
    const Eigen::Vector3f colour =
        patches.evaluate(patch, uv).colour().cwiseMax(0.0f).cwiseMin(1.0f);
    add(level + local.z() * frame.normal, colour, 1);
    add(level - local.z() * frame.normal, mean, kBelowWeight);
  }
  const Eigen::Matrix<double, kTerms, 3> solved =
      squares.selfadjointView<Eigen::Lower>().ldlt().solve(products);
  std::array<Eigen::Vector3f, kTerms> harmonics;
  for (std::size_t term = 0; term < kTerms; ++term) {
    harmonics[term] = solved.row(static_cast<Eigen::Index>(term)).transpose().cast<float>();
  }
  return harmonics;
}

/// How far neighbours lie along two axes of the tangent plane, right-handed with the normal: of a
/// grid of equal edges their length, either way. Nothing where there are none.
struct Spread {
  Eigen::Vector3f first, second;  ///< unit
  Eigen::Vector2f edge;           ///< metres, > 0
};
std::optional<Spread> spread_at(const core::Mesh& mesh, const core::VertexNeighbours& neighbours,
                                const core::TangentFrame& frame, std::size_t i) {
  Eigen::Matrix2f squares = Eigen::Matrix2f::Zero();
  for (const std::uint32_t other : neighbours.of(i)) {
    const Eigen::Vector3f edge = mesh.positions[other] - mesh.positions[i];
    const Eigen::Vector2f level(edge.dot(frame.tangent), edge.dot(frame.bitangent));
    squares += level * level.transpose() / static_cast<float>(neighbours.of(i).size());
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f> axes;
  axes.computeDirect(squares);
  // Of directions spread evenly, half of the squared length lies along each axis.
  const Eigen::Vector2f edge = (2.0f * axes.eigenvalues().cwiseMax(0.0f)).cwiseSqrt();
  if (!(edge[1] > 0)) return std::nullopt;
  const Eigen::Vector2f v = axes.eigenvectors().col(0);
  const Eigen::Vector3f first = v.x() * frame.tangent + v.y() * frame.bitangent;
  return Spread{first, frame.normal.cross(first), edge.cwiseMax(kNarrowest * edge[1])};
}

/// Harmonics per vertex, over the mesh that they were made from.
class SplatLightField final : public fitting::PatchLightField {
 public:
  SplatLightField(const fitting::Model& model, const Splats& splats, const Eigen::Matrix3f& axes)
      : splats_(splats.splats),
        frames_(model.mesh.positions.size()),
        splat_of_(model.mesh.positions.size(), 0),
        observed_(model.mesh.positions.size(), 1),
        axes_(axes) {
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      frames_[i] = core::tangent_frame(model.mesh.normals[i]);
    }
    for (std::size_t i = 0; i < splats.vertex.size(); ++i) splat_of_[splats.vertex[i]] = i;
  }

  [[nodiscard]] std::string_view representation() const override { return "splats"; }
  [[nodiscard]] std::size_t coefficient_count() const override {
    return 3 * kTerms * splats_.size();
  }
  [[nodiscard]] std::size_t patch_count() const override { return frames_.size(); }
  [[nodiscard]] fitting::WeightedColour evaluate(std::size_t patch,
                                                 const Eigen::Vector2f& uv) const override {
    const Eigen::Vector3f towards_eye = frames_[patch].in_object(core::hemisphere_from_disc(uv));
    return {splats_[splat_of_[patch]].colour(-(axes_ * towards_eye)).cwiseMax(0.0f), 1.0f};
  }
  [[nodiscard]] Eigen::Vector3f mean_colour(std::size_t patch) const override {
    return splats_[splat_of_[patch]].mean_colour();
  }
  [[nodiscard]] const std::vector<std::uint8_t>& observed() const override { return observed_; }

 private:
  std::vector<Splat> splats_;
  std::vector<core::TangentFrame> frames_;
  std::vector<std::size_t> splat_of_;  ///< of every vertex; the first for those that have none
  std::vector<std::uint8_t> observed_;
  Eigen::Matrix3f axes_;
};

}  // namespace

Eigen::Vector3f Splat::colour(const Eigen::Vector3f& direction) const {
  const Row row = harmonics_of(direction);
  Eigen::Vector3f sum = Eigen::Vector3f::Constant(0.5f);
  for (std::size_t term = 0; term < kTerms; ++term) {
    sum += static_cast<float>(row[static_cast<Eigen::Index>(term)]) * harmonics[term];
  }
  return sum;
}

Eigen::Vector3f Splat::mean_colour() const {
  constexpr auto y00 = static_cast<float>(fitting::spherical_harmonics::kY00);
  const Eigen::Vector3f mean = 0.5f + (y00 * harmonics[0]).array();
  return mean.cwiseMax(0.0f).cwiseMin(1.0f);
}

Splats make_splats(const fitting::Model& model, const Eigen::Matrix3f& axes) {
  const auto& patches = fitting::require_patches(*model.light_field, "an export of splats");
  const core::Mesh& mesh = model.mesh;
  const core::VertexNeighbours neighbours = core::vertex_neighbours(mesh);
  const std::vector<Eigen::Vector2f> places = disc_places();
  Splats splats;
  splats.offset = axes.cast<double>() * mesh.offset;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const core::TangentFrame frame = core::tangent_frame(mesh.normals[i]);
    const auto spread = spread_at(mesh, neighbours, frame, i);
    if (!spread) continue;
    Eigen::Matrix3f turn;
    turn << spread->first, spread->second, frame.normal;
    Splat splat;
    splat.position = axes * mesh.positions[i];
    splat.rotation = Eigen::Quaternionf(Eigen::Matrix3f(axes * turn)).normalized();
    const Eigen::Vector2f sigma = kSigmaPerEdge * spread->edge;
    splat.sigma = {sigma[0], sigma[1], kThickness * sigma.mean()};
    splat.opacity = kOpacity;
    splat.harmonics = fit_harmonics(patches, i, frame, axes, places);
    splats.splats.push_back(splat);
    splats.vertex.push_back(static_cast<std::uint32_t>(i));
  }
  return splats;
}

fitting::Model splat_model(const fitting::Model& model, const Splats& splats,
                           const Eigen::Matrix3f& axes) {
  return {model.mesh, std::make_unique<SplatLightField>(model, splats, axes), {}};
}

std::vector<std::string> splat_remarks(const fitting::Model& model) {
  std::vector<std::string> remarks{
      "what is measured is the loss in the colours of the splats; discs that overlap blur besides"};
  const auto* const patches = fitting::as_patches(*model.light_field);
  if (patches != nullptr && patches->texture_between_patches() != nullptr) {
    remarks.emplace_back(
        "splats stand at the vertices, finer detail of the texture is lost; the other formats keep "
        "it");
  }
  return remarks;
}

}  // namespace sheen::exporters
