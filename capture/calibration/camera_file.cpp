// SPDX-License-Identifier: MIT
#include "capture/calibration/camera_file.h"

#include "capture/calibration/camera_document.h"
#include "capture/files/text_file.h"
#include "core/diagnostics/error.h"
#include "core/files/write_file.h"
#include "core/text/lower_case.h"
#include "core/text/number.h"

#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace sheen::capture {
namespace {

constexpr std::size_t kMostCameraBytes = std::size_t{16} << 20;
constexpr double kInvisible_px = 0.05;  // terms that move nothing by more may be left out

/// Keys of one file, with errors that name it.
class KeyReader {
 public:
  KeyReader(const CameraKeys& keys, const std::filesystem::path& path) : keys_(keys), path_(path) {}

  [[noreturn]] void fail(const std::string& fault) const { refuse_camera_file(path_, fault); }
  [[noreturn]] void fail(const std::string& fault, const std::string& remedy) const {
    refuse_camera_file(path_, fault, remedy);
  }

  /// The words under the first of these names that is there; null where none is.
  [[nodiscard]] const std::vector<std::string>* find(
      std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      const auto found = keys_.find(name);
      if (found != keys_.end()) return &found->second;
    }
    return nullptr;
  }
  [[nodiscard]] bool has(const char* name) const { return keys_.contains(name); }

  [[nodiscard]] std::string text(std::initializer_list<const char*> names) const {
    const auto* words = find(names);
    return words != nullptr && !words->empty() ? core::lower_case(words->front()) : std::string();
  }

  [[nodiscard]] double number(const std::string& name, const std::string& word) const {
    const std::string lower = core::lower_case(word);
    if (lower.ends_with(".nan") || lower.ends_with(".inf"))
      fail(name + " holds a number not finite");
    const auto value = core::parse_number(word);
    if (!value) fail(name + " holds something not a number (" + core::why_no_number(word) + ")");
    if (!std::isfinite(*value)) fail(name + " holds a number not finite");
    return *value;
  }

  [[nodiscard]] std::vector<double> numbers(const std::string& name,
                                            const std::vector<std::string>& words) const {
    std::vector<double> values;
    for (const std::string& word : words) values.push_back(number(name, word));
    return values;
  }

  /// One number; `fallback` where the key is missing.
  [[nodiscard]] double number_of(const char* name, double fallback) const {
    const auto* words = find({name});
    return words == nullptr || words->empty() ? fallback : number(name, words->front());
  }

  [[nodiscard]] int side(const char* shown, std::initializer_list<const char*> names,
                         std::size_t place = 0) const {
    const auto* words = find(names);
    const auto whole =
        words != nullptr && place < words->size() ? whole_number((*words)[place]) : std::nullopt;
    if (!whole) fail(std::string(shown) + " is missing or no whole number");
    return static_cast<int>(std::clamp(*whole, -1LL, 1LL << 20));
  }

 private:
  /// Also 640.0, as JSON of other programs has it.
  static std::optional<long long> whole_number(const std::string& word) {
    const auto value = core::parse_number(word);
    if (!value || *value != std::floor(*value) || std::abs(*value) > 1e9) return std::nullopt;
    return static_cast<long long>(*value);
  }

  const CameraKeys& keys_;
  const std::filesystem::path& path_;
};

void read_size(const KeyReader& reader, LensRecord& record) {
  // Kalibr and Python's dumps write both sides in one list, width first.
  if (reader.find({"resolution", "image_size", "imageSize"}) != nullptr &&
      reader.find({"image_width", "image_Width", "width", "w"}) == nullptr) {
    record.width_px = reader.side("resolution", {"resolution", "image_size", "imageSize"}, 0);
    record.height_px = reader.side("resolution", {"resolution", "image_size", "imageSize"}, 1);
    return;
  }
  record.width_px = reader.side("image_width", {"image_width", "image_Width", "width", "w"});
  record.height_px = reader.side("image_height", {"image_height", "image_Height", "height", "h"});
}

void read_camera_matrix(const KeyReader& reader, LensRecord& record) {
  const auto* words = reader.find(
      {"camera_matrix", "Camera_Matrix", "cameraMatrix", "CameraMatrix", "K", "k", "mtx"});
  if (words == nullptr) reader.fail("camera_matrix is missing or no matrix of the expected size");
  const std::vector<double> K = reader.numbers("camera_matrix", *words);
  if (K.size() > 9 && K.size() <= 18) {
    reader.fail("camera_matrix holds " + std::to_string(K.size()) +
                " numbers, not 9; are there decimal commas? write points");
  }
  if (K.size() != 9) reader.fail("camera_matrix is not 3 x 3");
  if (K[3] != 0 || K[6] != 0 || K[7] != 0 || K[8] != 1 || std::abs(K[1]) > 1e-9 * std::abs(K[0])) {
    reader.fail("camera_matrix is not of the form fx 0 cx, 0 fy cy, 0 0 1");
  }
  record.focal_px = {K[0], K[4]};
  record.principal_px = {K[2], K[5]};
}

/// What the file says about the kind of its lens; rational where it says nothing.
core::LensKind kind_of(const KeyReader& reader) {
  const std::string camera = reader.text({"camera_model", "model_type", "camera_type"});
  const std::string distortion = reader.text({"distortion_model", "distortion_type"});
  const std::string flag = reader.text({"fisheye_model", "fisheye", "is_fisheye"});
  const auto is_one_of = [](const std::string& name, std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if ((!flag.empty() && flag != "0" && flag != "false") ||
      is_one_of(distortion, {"equidistant", "fisheye", "kannala_brandt", "equi"}) ||
      is_one_of(camera,
                {"fisheye", "opencv_fisheye", "kannala_brandt", "kannalabrandt8", "equidistant"})) {
    return core::LensKind::fisheye;
  }
  if (!is_one_of(camera, {"", "pinhole", "opencv", "perspective", "simple_pinhole", "radial",
                          "simple_radial", "brown"})) {
    reader.fail("camera_model is " + core::quotable(camera) + ", which is not modelled",
                "calibrate as a pinhole camera with radial and tangential distortion");
  }
  if (!is_one_of(distortion, {"", "plumb_bob", "radtan", "rational_polynomial", "none", "brown",
                              "radial-tangential", "modified_brown_conrady"})) {
    reader.fail("distortion_model is " + core::quotable(distortion) + ", which is not modelled",
                "calibrate with plumb_bob or rational_polynomial (radial and tangential)");
  }
  return core::LensKind::rational;
}

/// ROS: size and matrix are the sensor's; the images are its region of interest, of which
/// `binning` pixels were joined.
void take_region(const KeyReader& reader, LensRecord& record) {
  const auto take = [&](const std::string& axis, const std::string& side, int& side_px,
                        double& focal_px, double& principal_px) {
    const double offset = reader.number_of(("roi." + axis + "_offset").c_str(), 0);
    const double region = reader.number_of(("roi." + side).c_str(), 0);
    const double binning = std::max(1.0, reader.number_of(("binning_" + axis).c_str(), 1));
    const double seen = region > 0 ? region : side_px;
    if (!(offset >= 0 && offset + seen <= side_px)) reader.fail("roi lies outside of the image");
    side_px = static_cast<int>(seen / binning);
    focal_px /= binning;
    principal_px = (principal_px - offset - (binning - 1) / 2) / binning;
  };
  take("x", "width", record.width_px, record.focal_px.x(), record.principal_px.x());
  take("y", "height", record.height_px, record.focal_px.y(), record.principal_px.y());
}

/// OpenCV, ROS, and what Python programs dump under the same names.
LensRecord matrix_record(const KeyReader& reader) {
  LensRecord record;
  read_size(reader, record);
  read_camera_matrix(reader, record);
  record.kind = kind_of(reader);
  const auto* words =
      reader.find({"distortion_coefficients", "Distortion_Coefficients", "distCoeffs",
                   "dist_coeffs", "dist_coeff", "distortion_coeffs", "D", "d", "dist"});
  if (words == nullptr) {
    reader.fail("distortion_coefficients is missing or no matrix of the expected size");
  }
  record.distortion = reader.numbers("distortion_coefficients", *words);
  take_region(reader, record);
  return record;
}

/// One number a key, pixels counted as OpenCV does: ORB-SLAM's settings and many programs' JSON.
LensRecord plain_record(const KeyReader& reader) {
  LensRecord record;
  read_size(reader, record);
  record.kind = kind_of(reader);
  for (const char* name : {"fy", "cx", "cy"}) {
    if (!reader.has(name)) reader.fail(std::string(name) + " is missing");
  }
  const auto number = [&reader](const char* name) { return reader.number_of(name, 0); };
  record.focal_px = {number("fx"), number("fy")};
  record.principal_px = {number("cx"), number("cy")};
  record.distortion =
      record.kind == core::LensKind::fisheye
          ? std::vector<double>{number("k1"), number("k2"), number("k3"), number("k4")}
          : std::vector<double>{number("k1"), number("k2"), number("p1"), number("p2"),
                                number("k3")};
  return record;
}

LensRecord kalibr_record(const KeyReader& reader) {
  LensRecord record;
  read_size(reader, record);
  record.kind = kind_of(reader);
  const std::vector<double> f = reader.numbers("intrinsics", *reader.find({"intrinsics"}));
  if (f.size() != 4) reader.fail("intrinsics is no list of fu, fv, pu, pv");
  record.focal_px = {f[0], f[1]};
  record.principal_px = {f[2], f[3]};
  if (const auto* words = reader.find({"distortion_coeffs", "distortion_coefficients"})) {
    record.distortion = reader.numbers("distortion_coeffs", *words);
  } else if (reader.text({"distortion_model"}) != "none") {
    reader.fail("distortion_coeffs is missing");
  }
  return record;
}

/// nerfstudio and instant-ngp: pixels counted from the corner of the first one.
LensRecord nerfstudio_record(const KeyReader& reader) {
  LensRecord record;
  read_size(reader, record);
  record.kind = kind_of(reader);
  const double fx = reader.number_of("fl_x", 0);
  record.focal_px = {fx, reader.number_of("fl_y", fx)};
  record.principal_px = {reader.number_of("cx", record.width_px / 2.0) - 0.5,
                         reader.number_of("cy", record.height_px / 2.0) - 0.5};
  const auto k = [&reader](const char* name) { return reader.number_of(name, 0); };
  record.distortion = record.kind == core::LensKind::fisheye
                          ? std::vector<double>{k("k1"), k("k2"), k("k3"), k("k4")}
                          : std::vector<double>{k("k1"), k("k2"), k("p1"), k("p2"), k("k3")};
  return record;
}

/// Agisoft: principal point from the middle of the image, p1 and p2 the other way round, a term k4
/// of the eighth power and a skew b2 that OpenCV's model lacks.
LensRecord agisoft_record(const KeyReader& reader) {
  LensRecord record;
  record.width_px = reader.side("width", {"width"});
  record.height_px = reader.side("height", {"height"});
  const std::string projection = reader.text({"projection"});
  if (projection == "fisheye" || projection == "equidistant_fisheye") {
    record.kind = core::LensKind::fisheye;
  } else if (projection != "frame" && !projection.empty()) {
    reader.fail("projection is " + core::quotable(projection) + ", which is not modelled",
                "calibrate as a frame camera");
  }
  if (!reader.has("f")) {
    reader.fail(reader.has("fx") ? "is of an old version of PhotoScan (fx, fy)" : "f is missing",
                "export the calibration from Metashape, as Agisoft or OpenCV XML");
  }
  const double f = reader.number_of("f", 0);
  record.focal_px = {f + reader.number_of("b1", 0), f};
  record.principal_px = {record.width_px / 2.0 + reader.number_of("cx", 0) - 0.5,
                         record.height_px / 2.0 + reader.number_of("cy", 0) - 0.5};
  const auto k = [&reader](const char* name) { return reader.number_of(name, 0); };
  const double corner = std::hypot(record.width_px, record.height_px) / 2 / std::max(f, 1e-9);
  const bool is_fisheye = record.kind == core::LensKind::fisheye;
  const auto refuse = [&](const char* term) {
    reader.fail(std::string(term) + " is not 0, a term that is not modelled",
                std::string("adjust the calibration without ") + term);
  };
  if (std::abs(k("b2")) * corner > kInvisible_px) refuse("b2");
  if (!is_fisheye && std::abs(k("k4") * f * std::pow(corner, 9)) > kInvisible_px) refuse("k4");
  if (k("p3") != 0 || k("p4") != 0) refuse("p3");
  if (is_fisheye && (k("p1") != 0 || k("p2") != 0)) refuse("p1");
  record.distortion = is_fisheye ? std::vector<double>{k("k1"), k("k2"), k("k3"), k("k4")}
                                 : std::vector<double>{k("k1"), k("k2"), k("p2"), k("p1"), k("k3")};
  return record;
}

LensRecord record_of(const CameraDocument& document, const std::filesystem::path& path) {
  if (document.record) return *document.record;
  const KeyReader reader(document.keys, path);
  if (document.is_agisoft) return agisoft_record(reader);
  if (reader.has("intrinsics")) return kalibr_record(reader);
  if (reader.has("fl_x")) return nerfstudio_record(reader);
  if (reader.has("fx")) return plain_record(reader);
  return matrix_record(reader);
}

/// Ours alone: no other program's file has it.
double readout_s(const KeyReader& reader) {
  constexpr double longest_ms = 200;
  const double readout_ms = reader.number_of("readout_ms", 0);
  if (!(std::abs(readout_ms) <= longest_ms)) {
    reader.fail("readout_ms is not within 200 ms",
                "give the milliseconds from a frame's first row to its last; 0: all at once");
  }
  return 1e-3 * readout_ms;
}

}  // namespace

core::CameraModel read_camera(const std::filesystem::path& path) {
  const CameraDocument document =
      parse_camera_document(read_text_file(path, kMostCameraBytes), path);
  auto intrinsics = camera_of(record_of(document, path), path).intrinsics();
  intrinsics.readout_s = readout_s(KeyReader(document.keys, path));
  return core::CameraModel(intrinsics);
}

void write_camera(const std::filesystem::path& path, const core::CameraModel& camera) {
  const core::CameraModel::Intrinsics& intrinsics = camera.intrinsics();
  cv::Mat K = cv::Mat::eye(3, 3, CV_64F);
  K.at<double>(0, 0) = intrinsics.focal_px.x();
  K.at<double>(1, 1) = intrinsics.focal_px.y();
  K.at<double>(0, 2) = intrinsics.principal_px.x();
  K.at<double>(1, 2) = intrinsics.principal_px.y();
  const auto& k = intrinsics.distortion;
  const bool is_fisheye = intrinsics.lens == core::LensKind::fisheye;
  const bool is_rational = k[5] != 0 || k[6] != 0 || k[7] != 0;
  const std::vector<double> coefficients(k.begin(), k.begin() + (is_fisheye    ? 4
                                                                 : is_rational ? 8
                                                                               : 5));

  // In memory: OpenCV takes what follows a ? in a file's name for options, and says nothing of a
  // full disk.
  cv::FileStorage storage(
      ".yaml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
  storage << "image_width" << intrinsics.width_px << "image_height" << intrinsics.height_px;
  if (is_fisheye) storage << "fisheye_model" << 1;
  storage << "camera_matrix" << K << "distortion_coefficients"
          << cv::Mat(coefficients, true).reshape(1, 1);
  if (intrinsics.readout_s != 0) storage << "readout_ms" << 1e3 * intrinsics.readout_s;
  core::write_file(path, storage.releaseAndGetString());
}

}  // namespace sheen::capture
