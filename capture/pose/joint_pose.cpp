// SPDX-License-Identifier: MIT
#include "capture/pose/joint_pose.h"

#include "core/geometry/principal_axes.h"

#include <Eigen/Cholesky>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sheen::capture {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Rotation vector and translation of camera_from_board, as OpenCV counts them.
struct Pose {
  cv::Vec3d rotation;
  cv::Vec3d translation;
};

struct Correspondences {
  std::vector<int> tag_ids;        ///< one per four corners
  std::vector<cv::Point3d> board;  ///< metres
  std::vector<cv::Point2d> image;  ///< px
};

/// The camera as OpenCV's solvers take it. They know the rational lens only: for others corners are
/// matched in the image that a pinhole camera of the same focal length would see.
struct Lens {
  explicit Lens(const core::CameraModel& camera)
      : K(camera.intrinsics().focal_px.x(), 0, camera.intrinsics().principal_px.x(),  //
          0, camera.intrinsics().focal_px.y(), camera.intrinsics().principal_px.y(),  //
          0, 0, 1) {
    if (is_known(camera)) std::copy_n(camera.intrinsics().distortion.begin(), 8, distortion.val);
  }
  static bool is_known(const core::CameraModel& camera) {
    return camera.intrinsics().lens == core::LensKind::rational;
  }
  cv::Matx33d K;
  cv::Vec<double, 8> distortion;
};

/// Where the pinhole camera would see a corner; as it is for lenses that OpenCV knows.
std::optional<Eigen::Vector2d> matched_pixel(const core::CameraModel& camera,
                                             const Eigen::Vector2d& pixel) {
  if (Lens::is_known(camera)) return pixel;
  const auto ray = camera.unproject(pixel);
  if (!ray) return std::nullopt;
  const auto& lens = camera.intrinsics();
  return Eigen::Vector2d(ray->head<2>().cwiseProduct(lens.focal_px) + lens.principal_px);
}

Eigen::Isometry3d to_isometry(const Pose& pose) {
  cv::Matx33d R;
  cv::Rodrigues(pose.rotation, R);
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.val);
  transform.translation() = Eigen::Map<const Eigen::Vector3d>(pose.translation.val);
  return transform;
}

Pose to_pose(const Eigen::Isometry3d& transform) {
  const Eigen::AngleAxisd rotation(transform.linear());
  const Eigen::Vector3d r = rotation.angle() * rotation.axis();
  const Eigen::Vector3d t = transform.translation();
  return {{r.x(), r.y(), r.z()}, {t.x(), t.y(), t.z()}};
}

Correspondences match(const Board& board, const core::CameraModel& camera,
                      const std::vector<TagDetection>& detections) {
  Correspondences matches;
  for (const TagDetection& detection : detections) {
    const auto tag = board.tags.find(detection.id);
    if (tag == board.tags.end()) continue;
    std::vector<cv::Point2d> image;
    for (const Eigen::Vector2d& corner_px : detection.corners_px) {
      if (const auto pixel = matched_pixel(camera, corner_px))
        image.emplace_back(pixel->x(), pixel->y());
    }
    if (image.size() < 4) continue;  // beyond what the lens model reaches
    matches.tag_ids.push_back(detection.id);
    matches.image.insert(matches.image.end(), image.begin(), image.end());
    for (const Eigen::Vector3d& corner : tag->second.corners_in_board()) {
      matches.board.emplace_back(corner.x(), corner.y(), corner.z());
    }
  }
  return matches;
}

Correspondences keep_tags(const Correspondences& all, const std::vector<bool>& keep) {
  Correspondences kept;
  for (std::size_t i = 0; i < all.tag_ids.size(); ++i) {
    if (!keep[i]) continue;
    kept.tag_ids.push_back(all.tag_ids[i]);
    for (std::size_t c = 4 * i; c < 4 * i + 4; ++c) {
      kept.board.push_back(all.board[c]);
      kept.image.push_back(all.image[c]);
    }
  }
  return kept;
}

/// Distance of every corner from its projection, px; infinite behind the camera.
std::vector<double> residuals(const Correspondences& matches, const Lens& lens, const Pose& pose) {
  std::vector<cv::Point2d> projected;
  cv::projectPoints(matches.board, pose.rotation, pose.translation, lens.K, lens.distortion,
                    projected);
  const Eigen::Isometry3d camera_from_board = to_isometry(pose);
  std::vector<double> distances(projected.size());
  for (std::size_t i = 0; i < projected.size(); ++i) {
    const cv::Point3d& p = matches.board[i];
    const double depth = (camera_from_board * Eigen::Vector3d(p.x, p.y, p.z)).z();
    distances[i] = depth > 0 ? cv::norm(projected[i] - matches.image[i])
                             : std::numeric_limits<double>::infinity();
  }
  return distances;
}

double huber_cost(const std::vector<double>& distances, double width) {
  double cost = 0;
  for (const double r : distances) cost += r <= width ? r * r / 2 : width * (r - width / 2);
  return cost;
}

/// Cost for choosing among starts: far-off corners count a bounded amount each, so that one wrong
/// tag cannot decide.
double bounded_cost(const std::vector<double>& distances) {
  constexpr double bound_px = 10;
  double cost = 0;
  for (const double r : distances) cost += std::min(r * r, bound_px * bound_px);
  return cost;
}

/// Adds the solutions of one of OpenCV's solvers. `board_from_points` brings its frame to ours.
void add_starts(const std::vector<cv::Point3d>& points, const std::vector<cv::Point2d>& image,
                const Lens& lens, int solver, const Eigen::Isometry3d& board_from_points,
                std::vector<Pose>& starts) {
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  try {
    cv::solvePnPGeneric(points, image, lens.K, lens.distortion, rotations, translations, false,
                        static_cast<cv::SolvePnPMethod>(solver));
  } catch (const cv::Exception&) {
    return;  // degenerate points: this solver has no answer, others may
  }
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const Pose pose{rotations[i], translations[i]};
    if (!cv::checkRange(pose.rotation) || !cv::checkRange(pose.translation)) continue;
    starts.push_back(to_pose(to_isometry(pose) * board_from_points.inverse()));
  }
}

/// Solutions for points near one plane, which SQPNP alone may miss: IPPE gives both mirror poses.
void add_planar_starts(const Correspondences& matches, std::size_t first, std::size_t count,
                       const Lens& lens, std::vector<Pose>& starts) {
  // Lay a plane through the points.
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const cv::Point3d& p = matches.board[first + i];
    points.col(static_cast<Eigen::Index>(i)) = Eigen::Vector3d(p.x, p.y, p.z);
  }
  const core::PrincipalAxes plane = core::principal_axes(points);
  if (plane.spread[2] > 0.1 * plane.spread[1]) return;
  Eigen::Isometry3d board_from_plane = Eigen::Isometry3d::Identity();
  board_from_plane.linear() = plane.axes;
  if (plane.axes.determinant() < 0) board_from_plane.linear().col(2) *= -1;
  board_from_plane.translation() = plane.mean;

  // Solve in that plane.
  std::vector<cv::Point3d> flat;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d p = board_from_plane.inverse() * points.col(i);
    flat.emplace_back(p.x(), p.y(), 0);
  }
  const auto begin = matches.image.begin() + static_cast<std::ptrdiff_t>(first);
  const std::vector<cv::Point2d> image(begin, begin + static_cast<std::ptrdiff_t>(count));
  add_starts(flat, image, lens, cv::SOLVEPNP_IPPE, board_from_plane, starts);
}

/// All corners at once, and each tag on its own in case a few tags spoil the whole.
std::vector<Pose> find_starts(const Correspondences& matches, const Lens& lens) {
  std::vector<Pose> starts;
  add_starts(matches.board, matches.image, lens, cv::SOLVEPNP_SQPNP, Eigen::Isometry3d::Identity(),
             starts);
  add_planar_starts(matches, 0, matches.board.size(), lens, starts);
  for (std::size_t first = 0; first < matches.board.size(); first += 4) {
    add_planar_starts(matches, first, 4, lens, starts);
  }
  return starts;
}

/// One damped step of reweighted least squares; the weights make it Huber's cost.
Vector6d solve_step(const cv::Mat& J, const std::vector<cv::Point2d>& projected,
                    const Correspondences& matches, double huber_px, double damping) {
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6d g = Vector6d::Zero();
  for (std::size_t i = 0; i < projected.size(); ++i) {
    const cv::Point2d error = matches.image[i] - projected[i];
    const double distance = cv::norm(error);
    const double weight = distance <= huber_px ? 1 : huber_px / distance;
    // Columns of OpenCV's Jacobian: rotation vector, translation, then the intrinsics.
    const Eigen::Map<const Vector6d> jx(J.ptr<double>(static_cast<int>(2 * i)));
    const Eigen::Map<const Vector6d> jy(J.ptr<double>(static_cast<int>(2 * i + 1)));
    A += weight * (jx * jx.transpose() + jy * jy.transpose());
    g += weight * (jx * error.x + jy * error.y);
  }
  A.diagonal() *= 1 + damping;
  return A.ldlt().solve(g);
}

/// Levenberg-Marquardt on the distorted reprojection with Huber's cost. Ceres in its place reaches
/// the same pose and takes as long (build/bench/micro_joint_pose: 1.29 ms with this for 24
/// tags, 1.54 with Ceres; most of it are the starts), and six unknowns are no reason for a second
/// solver.
Pose refine(const Correspondences& matches, const Lens& lens, Pose pose, double huber_px) {
  constexpr int max_steps = 30;
  double damping = 1e-4;
  double cost = huber_cost(residuals(matches, lens, pose), huber_px);
  std::vector<cv::Point2d> projected;
  cv::Mat J;
  for (int step = 0; step < max_steps && std::isfinite(cost); ++step) {
    cv::projectPoints(matches.board, pose.rotation, pose.translation, lens.K, lens.distortion,
                      projected, J);
    const Vector6d delta = solve_step(J, projected, matches, huber_px, damping);
    if (!delta.allFinite()) break;
    const Pose candidate{pose.rotation + cv::Vec3d(delta[0], delta[1], delta[2]),
                         pose.translation + cv::Vec3d(delta[3], delta[4], delta[5])};
    const double candidate_cost = huber_cost(residuals(matches, lens, candidate), huber_px);
    if (!(candidate_cost < cost)) {
      damping *= 10;
      if (damping > 1e6) break;
      continue;
    }
    const bool has_converged = cost - candidate_cost < 1e-12 * cost;
    pose = candidate;
    cost = candidate_cost;
    damping = std::max(damping / 10, 1e-9);
    if (has_converged) break;
  }
  return pose;
}

double tag_rms(const std::vector<double>& distances, std::size_t tag) {
  double sum = 0;
  for (std::size_t c = 4 * tag; c < 4 * tag + 4; ++c) sum += distances[c] * distances[c];
  return std::sqrt(sum / 4);
}

/// Tags that fit; the others lie far above the rest. At most a third may go: beyond that the board
/// or the camera is wrong, which the gate must see.
std::vector<bool> find_fitting_tags(const std::vector<double>& distances) {
  constexpr double far_above = 4;
  constexpr double always_fine_px = 0.8;
  std::vector<double> rms(distances.size() / 4);
  for (std::size_t i = 0; i < rms.size(); ++i) rms[i] = tag_rms(distances, i);
  std::vector<double> sorted = rms;
  std::sort(sorted.begin(), sorted.end());
  const double limit = std::max(always_fine_px, far_above * sorted[sorted.size() / 2]);
  const double worst_kept = sorted[sorted.size() - 1 - sorted.size() / 3];
  std::vector<bool> fits(rms.size());
  for (std::size_t i = 0; i < rms.size(); ++i) fits[i] = rms[i] <= std::max(limit, worst_kept);
  return fits;
}

/// The start from which the corners fit best after a rough descent.
std::optional<Pose> find_best_pose(const Correspondences& matches, const Lens& lens,
                                   double huber_px) {
  constexpr std::size_t promising = 4;
  std::vector<std::pair<double, Pose>> ranked;
  for (const Pose& start : find_starts(matches, lens)) {
    ranked.emplace_back(bounded_cost(residuals(matches, lens, start)), start);
  }
  const auto by_cost = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::stable_sort(ranked.begin(), ranked.end(), by_cost);
  ranked.resize(std::min(ranked.size(), promising));
  for (auto& [cost, pose] : ranked) {
    pose = refine(matches, lens, pose, huber_px);
    cost = bounded_cost(residuals(matches, lens, pose));
  }
  const auto best = std::min_element(ranked.begin(), ranked.end(), by_cost);
  if (best == ranked.end() || !std::isfinite(best->first)) return std::nullopt;
  return best->second;
}

}  // namespace

std::optional<JointPose> estimate_joint_pose(const Board& board, const core::CameraModel& camera,
                                             const std::vector<TagDetection>& detections) {
  constexpr double huber_px = 1;
  constexpr int max_drops = 3;
  const Lens lens(camera);
  Correspondences matches = match(board, camera, detections);
  if (matches.tag_ids.empty()) return std::nullopt;

  // Find and refine the pose over everything.
  const auto start = find_best_pose(matches, lens, huber_px);
  if (!start) return std::nullopt;
  Pose pose = *start;

  // Drop the tags far above the rest and refine again.
  const std::size_t fewest = matches.tag_ids.size() - matches.tag_ids.size() / 3;
  for (int drop = 0; drop < max_drops && matches.tag_ids.size() > fewest; ++drop) {
    const std::vector<bool> fits = find_fitting_tags(residuals(matches, lens, pose));
    const auto kept = static_cast<std::size_t>(std::count(fits.begin(), fits.end(), true));
    if (kept == matches.tag_ids.size() || kept < fewest) break;
    matches = keep_tags(matches, fits);
    pose = refine(matches, lens, pose, huber_px);
  }

  // Report what the remaining corners say.
  double sum = 0;
  for (const double distance : residuals(matches, lens, pose)) sum += distance * distance;
  const double rms = std::sqrt(sum / static_cast<double>(matches.board.size()));
  if (!std::isfinite(rms)) return std::nullopt;
  return JointPose{to_isometry(pose), rms, matches.tag_ids};
}

}  // namespace sheen::capture
