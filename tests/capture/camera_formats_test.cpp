// SPDX-License-Identifier: MIT
#include "capture/calibration/camera_file.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include <cmath>
#include <random>
#include <regex>
#include <sstream>

namespace sheen::capture::test {
namespace {

using core::CameraModel;
using core::LensKind;
using tests::TemporaryFolder;

/// One radial camera, which every form below describes.
const CameraModel kRadial({.width_px = 1280,
                           .height_px = 720,
                           .focal_px = {900.5, 902.25},
                           .principal_px = {641.5, 357.75},
                           .distortion = {-0.25, 0.08, 0.001, -0.002, 0.01}});
/// One fisheye, as well.
const CameraModel kFisheye({.width_px = 1280,
                            .height_px = 720,
                            .focal_px = {420.5, 421.25},
                            .principal_px = {638.5, 361.75},
                            .distortion = {-0.02, 0.006, -0.003, 0.0004},
                            .lens = LensKind::fisheye});

void expect_same(const CameraModel& read, const CameraModel& expected) {
  const auto& a = read.intrinsics();
  const auto& b = expected.intrinsics();
  EXPECT_EQ(a.width_px, b.width_px);
  EXPECT_EQ(a.height_px, b.height_px);
  EXPECT_EQ(a.lens, b.lens);
  // Decimal numbers of few digits come back to a rounding; sums with half pixels to another.
  EXPECT_LT((a.focal_px - b.focal_px).norm(), 1e-9);
  EXPECT_LT((a.principal_px - b.principal_px).norm(), 1e-9);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(a.distortion[i], b.distortion[i], 1e-12) << i;
}

class CameraForms : public ::testing::Test {
 protected:
  CameraModel read(const std::string& name, const std::string& text) {
    return read_camera(folder_.write(name, text));
  }
  template <typename... Words>
  void refuse(const std::string& name, const std::string& text, const Words&... words) {
    const auto path = folder_.write(name, text);
    expect_bad_input([&] { read_camera(path); }, name, words...);
  }

  TemporaryFolder folder_;
};

TEST_F(CameraForms, DecimalCommasAreNamed) {
  refuse("camera.yaml",
         "image_width: 640\nimage_height: 480\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
         "  data: [600,5, 0, 320, 0, 600,5, 240, 0, 0, 1]\n"
         "distortion_coefficients:\n  rows: 1\n  cols: 4\n  data: [0, 0, 0, 0]\n",
         "decimal commas");
}

std::string ros(const std::string& model, const std::string& coefficients, bool is_fisheye) {
  const std::string K = is_fisheye ? "[420.5, 0, 638.5, 0, 421.25, 361.75, 0, 0, 1]"
                                   : "[900.5, 0.0, 641.5, 0.0, 902.25, 357.75, 0.0, 0.0, 1.0]";
  return "image_width: 1280\nimage_height: 720\ncamera_name: head\ncamera_matrix:\n  rows: 3\n"
         "  cols: 3\n  data: " +
         K + "\ndistortion_model: " + model +
         "\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: " + coefficients +
         "\nrectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
         "projection_matrix:\n  rows: 3\n  cols: 4\n"
         "  data: [880, 0, 640, 0, 0, 890, 360, 0, 0, 0, 1, 0]\n";
}

TEST_F(CameraForms, RosCameraInfo) {
  expect_same(read("ost.yaml", ros("plumb_bob", "[-0.25, 0.08, 0.001, -0.002, 0.01]", false)),
              kRadial);
  expect_same(read("ost.yaml", ros("rational_polynomial",
                                   "[-0.25, 0.08, 0.001, -0.002, 0.01, 0, 0, 0]", false)),
              kRadial);
  expect_same(read("ost.yaml", ros("equidistant", "[-0.02, 0.006, -0.003, 0.0004]", true)),
              kFisheye);
  // As a topic prints it.
  expect_same(read("info.yaml",
                   "header:\n  seq: 5\n  frame_id: \"cam\"\nheight: 720\nwidth: 1280\n"
                   "distortion_model: \"plumb_bob\"\nD: [-0.25, 0.08, 0.001, -0.002, 0.01]\n"
                   "K: [900.5, 0, 641.5, 0, 902.25, 357.75, 0, 0, 1]\n"
                   "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"),
              kRadial);
  // A region of a sensor of 2600 x 1500 whose pixels were joined two by two.
  expect_same(
      read("info.yaml",
           "height: 1500\nwidth: 2600\n"
           "distortion_model: \"plumb_bob\"\nD: [-0.25, 0.08, 0.001, -0.002, 0.01]\n"
           "K: [1801, 0, 1303.5, 0, 1804.5, 746, 0, 0, 1]\n"
           "binning_x: 2\nbinning_y: 2\n"
           "roi: {x_offset: 20, y_offset: 30, height: 1440, width: 2560, do_rectify: false}"),
      kRadial);
  refuse("ost.yaml", ros("thin_prism_fisheye", "[0, 0, 0, 0]", true), "thin_prism_fisheye");
}

TEST_F(CameraForms, OneNumberAKey) {
  const std::string numbers =
      "k1: -0.25\nP.k2: 0.08\nP.p1: 0.001\nP.p2: -0.002\nP.k3: 0.01\nP.fx: 900.5\nP.fy: 902.25\n"
      "P.cx: 641.5\nP.cy: 357.75\nP.width: 1280\nP.height: 720\n";
  const auto with_prefix = [&](const std::string& prefix) {
    return prefix + std::regex_replace(numbers, std::regex("P[.]"), prefix);
  };
  expect_same(read("plain.yaml", with_prefix("")), kRadial);
  expect_same(
      read("orb_slam.yaml", "%YAML:1.0\nCamera.type: \"PinHole\"\n" + with_prefix("Camera.")),
      kRadial);
  expect_same(read("orb_slam.yaml",
                   "%YAML:1.0\nCamera.type: \"KannalaBrandt8\"\nCamera1.fx: 420.5\n"
                   "Camera1.fy: 421.25\nCamera1.cx: 638.5\nCamera1.cy: 361.75\n"
                   "Camera1.k1: -0.02\nCamera1.k2: 0.006\nCamera1.k3: -0.003\n"
                   "Camera1.k4: 0.0004\nCamera.width: 1280\nCamera.height: 720\n"),
              kFisheye);
  expect_same(read("phone.json",
                   R"({"fx": 900.5, "fy": 902.25, "cx": 641.5, "cy": 357.75, "width": 1280,
                       "height": 720, "k1": -0.25, "k2": 0.08, "p1": 0.001, "p2": -0.002,
                       "k3": 0.01})"),
              kRadial);
  refuse("half.json", R"({"fx": 900.5, "fy": 902.25, "width": 1280, "height": 720})", "cx");
}

TEST_F(CameraForms, KalibrCamchain) {
  const auto camchain = [](const std::string& name, const std::string& more) {
    return name + ":\n  cam_overlaps: []\n  camera_model: pinhole\n" + more +
           "  resolution: [1280, 720]\n  rostopic: /camera/image\n";
  };
  const std::string radial =
      "  distortion_coeffs: [-0.25, 0.08, 0.001, -0.002]\n  distortion_model: radtan\n"
      "  intrinsics: [900.5, 902.25, 641.5, 357.75]\n";
  auto without_k3 = kRadial.intrinsics();
  without_k3.distortion[4] = 0;
  expect_same(read("camchain.yaml", camchain("cam0", radial)), CameraModel(without_k3));
  expect_same(read("camchain.yaml", camchain("cam0",
                                             "  distortion_coeffs: [-0.02, 0.006, -0.003, 0.0004]\n"
                                             "  distortion_model: equidistant\n"
                                             "  intrinsics: [420.5, 421.25, 638.5, 361.75]\n")),
              kFisheye);
  refuse("camchain.yaml", camchain("cam0", radial) + camchain("cam1", radial), "2 cameras");
  refuse("camchain.yaml",
         camchain("cam0",
                  "  distortion_coeffs: [0.9]\n  distortion_model: fov\n"
                  "  intrinsics: [420.5, 421.25, 638.5, 361.75]\n"),
         "fov");
}

TEST_F(CameraForms, OpenCvInItsThreeForms) {
  const cv::Matx33d K(900.5, 0, 641.5, 0, 902.25, 357.75, 0, 0, 1);
  const cv::Mat D = (cv::Mat_<double>(5, 1) << -0.25, 0.08, 0.001, -0.002, 0.01);
  // OpenCV's own calibration sample puts a matrix of every view and every point beside.
  const cv::Mat points(3000, 60, CV_32FC2, cv::Scalar(12.5, -3));
  for (const char* name : {"camera.yaml", "camera.xml", "camera.json"}) {
    SCOPED_TRACE(name);
    const auto path = folder_ / name;
    cv::FileStorage storage(path.string(), cv::FileStorage::WRITE);
    storage << "calibration_time"
            << "Tue 3 Mar 2020 \"10:00:00\""
            << "image_width" << 1280 << "image_height" << 720 << "fisheye_model" << 0
            << "camera_matrix" << cv::Mat(K) << "distortion_coefficients" << D << "image_points"
            << points;
    storage.release();
    ASSERT_GT(std::filesystem::file_size(path), 500'000u);
    expect_same(read_camera(path), kRadial);
  }
}

TEST_F(CameraForms, AgisoftIsWhatItsManualSays) {
  // Metashape: x' = x (1 + K1 r^2 + ...) + P1 (r^2 + 2 x^2) + 2 P2 x y, u = w/2 + cx + x' f + x'
  // b1; pixels are counted from the corner of the first one, so that its centre is at 0.5.
  const auto xml = [](const std::string& more) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<calibration>\n  <projection>" + more +
           "</projection>\n  <width>1280</width>\n  <height>720</height>\n  <f>902.25</f>\n"
           "  <cx>2.0</cx>\n  <cy>-1.75</cy>\n  <b1>-1.75</b1>\n  <k1>-0.25</k1>\n"
           "  <k2>0.08</k2>\n  <k3>0.01</k3>\n  <p1>-0.002</p1>\n  <p2>0.001</p2>\n"
           "  <date>2020-01-01T00:00:00Z</date>\n</calibration>\n";
  };
  const CameraModel camera = read("agisoft.xml", xml("frame"));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> range(-0.5, 0.5);
  for (int i = 0; i < 100; ++i) {
    const double x = range(random), y = range(random), r2 = x * x + y * y;
    const double radial = 1 + r2 * (-0.25 + r2 * (0.08 + r2 * 0.01));
    const double dx = x * radial - 0.002 * (r2 + 2 * x * x) + 2 * 0.001 * x * y;
    const double dy = y * radial + 0.001 * (r2 + 2 * y * y) + 2 * -0.002 * x * y;
    const Eigen::Vector2d pixel(640 + 2.0 + dx * (902.25 - 1.75) - 0.5,
                                360 - 1.75 + dy * 902.25 - 0.5);
    EXPECT_LT((*camera.project({x, y, 1}) - pixel).norm(), 1e-9);
  }
  // Its fisheye: the same polynomial of the angle, without the terms that ours lacks.
  std::string fisheye = xml("equidistant_fisheye");
  fisheye.replace(fisheye.find("<p1>-0.002"), 10, "<p1>0.000 ");
  fisheye.replace(fisheye.find("<p2>0.001"), 9, "<p2>0.000");
  const CameraModel wide = read("fisheye.xml", fisheye);
  EXPECT_EQ(wide.intrinsics().lens, LensKind::fisheye);
  const double theta = 0.9, t2 = theta * theta;
  const double r = theta * (1 + t2 * (-0.25 + t2 * (0.08 + t2 * 0.01)));
  const auto pixel = wide.project({std::tan(theta), 0, 1});
  EXPECT_NEAR(pixel->x(), 640 + 2.0 - 0.5 + r * (902.25 - 1.75), 1e-9);
  refuse("agisoft.xml", xml("cylindrical"), "cylindrical");
  std::string skewed = xml("frame");
  skewed.insert(skewed.find("<k1>"), "<b2>3.5</b2>");
  refuse("agisoft.xml", skewed, "b2");
}

TEST_F(CameraForms, ColmapAndNerfstudioCountFromTheCorner) {
  auto expected = kRadial.intrinsics();
  expected.distortion[4] = 0;
  expect_same(read("cameras.txt",
                   "# Camera list with one line of data per camera:\n#   CAMERA_ID, MODEL, WIDTH, "
                   "HEIGHT, PARAMS[]\n1 OPENCV 1280 720 900.5 902.25 642.0 358.25 -0.25 0.08 "
                   "0.001 -0.002\n"),
              CameraModel(expected));
  expect_same(read("cameras.txt",
                   "1 OPENCV_FISHEYE 1280 720 420.5 421.25 639 362.25 -0.02 0.006 -0.003 0.0004\n"),
              kFisheye);
  expect_same(read("transforms.json",
                   R"({"camera_model": "OPENCV", "w": 1280, "h": 720, "fl_x": 900.5, "fl_y": 902.25,
                       "cx": 642.0, "cy": 358.25, "k1": -0.25, "k2": 0.08, "p1": 0.001,
                       "p2": -0.002, "frames": [{"file_path": "a.png"}]})"),
              CameraModel(expected));
  expect_same(read("transforms.json",
                   R"({"camera_model": "OPENCV_FISHEYE", "w": 1280, "h": 720, "fl_x": 420.5,
                       "fl_y": 421.25, "cx": 639, "cy": 362.25, "k1": -0.02, "k2": 0.006,
                       "k3": -0.003, "k4": 0.0004, "frames": []})"),
              kFisheye);
  refuse("cameras.txt", "1 THIN_PRISM_FISHEYE 1280 720 1 1 1 1 1 1 1 1 1 1 1 1\n", "THIN_PRISM");
}

TEST_F(CameraForms, ColmapsSmallerModelsAreTheLargerOnesWithoutTerms) {
  const auto same = [this](const std::string& smaller, const std::string& larger) {
    SCOPED_TRACE(smaller);
    expect_same(read("smaller.txt", "1 " + smaller + "\n"),
                read("larger.txt", "1 " + larger + "\n"));
  };
  same("SIMPLE_PINHOLE 640 480 500 320 240", "OPENCV 640 480 500 500 320 240 0 0 0 0");
  same("SIMPLE_RADIAL 640 480 500 320 240 0.1", "OPENCV 640 480 500 500 320 240 0.1 0 0 0");
  same("RADIAL 640 480 500 320 240 0.1 0.02",
       "FULL_OPENCV 640 480 500 500 320 240 0.1 0.02 0 0 0 0 0 0");
  same("SIMPLE_RADIAL_FISHEYE 640 480 300 320 240 0.1",
       "OPENCV_FISHEYE 640 480 300 300 320 240 0.1 0 0 0");
  same("RADIAL_FISHEYE 640 480 300 320 240 0.1 0.02",
       "OPENCV_FISHEYE 640 480 300 300 320 240 0.1 0.02 0 0");
  refuse("cameras.txt", "1 OPENCV 640 480 500 500 320\n", "3 parameters", "has 8");
  refuse("cameras.txt", "1 PINHOLE 640 480 500 500 320,5 240\n", "decimal comma");
}

TEST_F(CameraForms, FisheyesAreWrittenAndReadBack) {
  const auto path = folder_ / "fisheye.yaml";
  write_camera(path, kFisheye);
  expect_same(read_camera(path), kFisheye);
  // OpenCV's calibration sample reads the same flag.
  cv::FileStorage storage(path.string(), cv::FileStorage::READ);
  EXPECT_EQ(static_cast<int>(storage["fisheye_model"]), 1);
}

TEST_F(CameraForms, FisheyesProjectAsOpenCvDoes) {
  const CameraModel camera =
      read("ost.yaml", ros("equidistant", "[-0.02, 0.006, -0.003, 0.0004]", true));
  std::vector<cv::Point3d> points;
  for (int i = 0; i < 80; ++i) {
    const double angle = i * M_PI / 180;  // from the axis
    points.emplace_back(std::sin(angle) * std::cos(i), std::sin(angle) * std::sin(i),
                        std::cos(angle));
  }
  std::vector<cv::Point2d> pixels;
  cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(),
                             cv::Matx33d(420.5, 0, 638.5, 0, 421.25, 361.75, 0, 0, 1),
                             cv::Vec4d(-0.02, 0.006, -0.003, 0.0004));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto ours = camera.project({points[i].x, points[i].y, points[i].z});
    ASSERT_TRUE(ours);
    EXPECT_NEAR(ours->x(), pixels[i].x, 1e-8);
    EXPECT_NEAR(ours->y(), pixels[i].y, 1e-8);
  }
}

TEST_F(CameraForms, WrongUnitsAndCountsAreNamed) {
  // A focal length in millimetres.
  std::string text = ros("plumb_bob", "[0, 0, 0, 0, 0]", false);
  text.replace(text.find("900.5, 0.0"), 5, "4.25 ");
  text.replace(text.find("902.25"), 6, "4.25  ");
  refuse("ost.yaml", text, "degrees", "millimetres");
  // Twelve coefficients with a thin prism.
  refuse("ost.yaml", ros("rational_polynomial", "[0, 0, 0, 0, 0, 0, 0, 0, 0.1, 0, 0, 0]", false),
         "thin prism");
  refuse("ost.yaml", ros("equidistant", "[0.1, 0.2, 0.3]", true), "4 coefficients");
  // A decimal comma makes two of one number.
  refuse("ost.yaml", ros("plumb_bob", "[\"-0,25\", 0.08, 0.001, -0.002, 0.01]", false), "comma");
}

/// Reads the text whatever it says; anything but a camera or a refusal fails the test.
void expect_read_or_refused(const tests::TemporaryFolder& folder, const std::string& name,
                            const std::string& text) {
  const auto path = folder.write(name, text);
  try {
    EXPECT_GT(read_camera(path).width_px(), 0);
  } catch (const core::Error& error) {
    EXPECT_EQ(error.kind(), core::Error::Kind::bad_input);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

TEST_F(CameraForms, WhatIsCutOrAlteredIsReadOrRefused) {
  const std::vector<std::string> texts = {
      ros("plumb_bob", "[-0.25, 0.08, 0.001, -0.002, 0.01]", false),
      "%YAML:1.0\n---\nimage_width: 1280\nimage_height: 720\ncamera_matrix: !!opencv-matrix\n"
      "   rows: 3\n   cols: 3\n   dt: d\n   data: [ 900., 0., 640., 0., 900., 360., 0., 0., 1. ]\n"
      "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 4\n   dt: d\n"
      "   data: [ 0.1, 0., 0., 0. ]\n",
      "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0, 0, 0, 0]\n  distortion_model: "
      "radtan\n  intrinsics: [900.5, 902.25, 641.5, 357.75]\n  resolution: [1280, 720]\n",
      "<?xml version=\"1.0\"?>\n<calibration><projection>frame</projection><width>1280</width>"
      "<height>720</height><f>900</f><cx>0</cx><cy>0</cy><k1>0.1</k1></calibration>\n",
      R"({"w": 1280, "h": 720, "fl_x": 900, "fl_y": 900, "cx": 640, "cy": 360, "frames": []})",
      "1 OPENCV 1280 720 900 900 640 360 0 0 0 0\n"};
  std::mt19937 random(9);
  for (const std::string& text : texts) {
    for (std::size_t size = 0; size < text.size(); ++size) {
      expect_read_or_refused(folder_, "cut.yaml", text.substr(0, size));
    }
    for (int run = 0; run < 300; ++run) {
      std::string altered = text;
      for (int i = 0; i < 3; ++i) {
        altered[random() % altered.size()] = static_cast<char>(random() % 256);
      }
      expect_read_or_refused(folder_, "altered.yaml", altered);
    }
  }
}

TEST_F(CameraForms, MarksAndLineEndsOfOtherSystemsAreRead) {
  std::string text = "\xef\xbb\xbf" + ros("plumb_bob", "[-0.25, 0.08, 0.001, -0.002, 0.01]", false);
  for (std::size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n', i + 2)) {
    text.replace(i, 1, "\r\n");
  }
  expect_same(read("windows.yaml", text), kRadial);
}

}  // namespace
}  // namespace sheen::capture::test
