// SPDX-License-Identifier: MIT
#include "capture/calibration/calibration_images.h"
#include "capture/source/image_folder_source.h"
#include "capture/source/light_curve.h"
#include "capture/source/quarter_turn.h"
#include "capture/source/still_reader.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <lcms2.h>
#include <opencv2/imgcodecs.hpp>
#include <zlib.h>

#include <cmath>
#include <random>

namespace sheen::capture::test {
namespace {

using tests::read_file;
using tests::TemporaryFolder;

constexpr ImageSize kStillSize{48, 32};

/// Differs in all four corners, so that every turn and mirror shows.
cv::Mat corner_image() {
  cv::Mat image(kStillSize.height_px, kStillSize.width_px, CV_8UC3, cv::Scalar(60, 60, 60));
  image(cv::Rect(0, 0, 24, 16)) = cv::Scalar(40, 60, 200);
  image(cv::Rect(24, 0, 24, 16)) = cv::Scalar(60, 200, 40);
  image(cv::Rect(0, 16, 24, 16)) = cv::Scalar(200, 60, 60);
  return image;
}

std::string encoded(const cv::Mat& image, const char* ending) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(ending, image, bytes, {cv::IMWRITE_JPEG_QUALITY, 100});
  return {bytes.begin(), bytes.end()};
}

/// A JPEG with an EXIF block that holds nothing but the orientation, in either byte order.
std::string with_orientation(const std::string& jpeg, int orientation, bool is_big_endian) {
  const std::string tiff =
      is_big_endian ? std::string("MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0", 19) +
                          static_cast<char>(orientation) + std::string(6, '\0')
                    : std::string("II\x2a\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0", 18) +
                          static_cast<char>(orientation) + std::string(7, '\0');
  const std::string block = std::string("Exif\0\0", 6) + tiff;
  const std::size_t length = block.size() + 2;
  std::string segment = "\xff\xe1";
  segment += static_cast<char>(length >> 8U);
  segment += static_cast<char>(length & 0xffU);
  return jpeg.substr(0, 2) + segment + block + jpeg.substr(2);
}

/// A PNG with another chunk behind its header.
std::string with_chunk(const std::string& png, const std::string& type, const std::string& data) {
  const auto big = [](std::size_t value) {
    std::string bytes;
    for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(value >> shift);
    return bytes;
  };
  const std::string body = type + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  constexpr std::size_t header = 8 + 25;
  return png.substr(0, header) + big(data.size()) + body + big(sum) + png.substr(header);
}

std::string with_profile(const std::string& png, const std::string& profile) {
  std::string packed(compressBound(static_cast<uLong>(profile.size())), '\0');
  auto size = static_cast<uLongf>(packed.size());
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(profile.data()), static_cast<uLong>(profile.size()));
  packed.resize(size);
  return with_chunk(png, "iCCP", std::string("test\0\0", 6) + packed);
}

/// An ICC profile of RGB with these primaries, the white of D65 and sRGB's curve.
std::string icc_profile(const cmsCIExyYTRIPLE& primaries) {
  const cmsCIExyY white{0.3127, 0.3290, 1};
  const cmsFloat64Number srgb[] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  cmsToneCurve* const curve = cmsBuildParametricToneCurve(nullptr, 4, srgb);
  cmsToneCurve* const curves[] = {curve, curve, curve};
  cmsHPROFILE profile = cmsCreateRGBProfile(&white, &primaries, curves);
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::string bytes(size, '\0');
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  cmsFreeToneCurve(curve);
  return bytes;
}
const cmsCIExyYTRIPLE kSrgbPrimaries{{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};
const cmsCIExyYTRIPLE kP3Primaries{{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}};

TEST(StillReader, TakesThePixelsThatAreStoredWhateverExifSays) {
  const TemporaryFolder folder;
  const std::string jpeg = encoded(corner_image(), ".jpg");
  StillReader plain;
  const cv::Mat stored = plain.read(folder.write("plain.jpg", jpeg), kStillSize);
  for (int orientation = 1; orientation <= 8; ++orientation) {
    for (const bool is_big_endian : {false, true}) {
      StillReader reader;
      const cv::Mat image = reader.read(
          folder.write("turned.jpg", with_orientation(jpeg, orientation, is_big_endian)),
          kStillSize);
      EXPECT_EQ(cv::norm(image, stored, cv::NORM_INF), 0) << orientation;
      EXPECT_EQ(reader.notes().size(), orientation == 1 ? 0u : 1u) << orientation;
    }
  }
}

TEST(StillReader, TurnsWhereTheCameraIsForTheTurnedImages) {
  const TemporaryFolder folder;
  const std::string jpeg = encoded(corner_image(), ".jpg");
  const ImageSize upright{kStillSize.height_px, kStillSize.width_px};
  for (const int orientation : {5, 6, 7, 8}) {  // those that exchange width and height
    const auto path = folder.write("turned.jpg", with_orientation(jpeg, orientation, false));
    StillReader reader;
    const cv::Mat image = reader.read(path, upright);
    // As OpenCV turns it, which obeys EXIF; decoders differ by a step.
    const cv::Mat shown = cv::imread(path.string(), cv::IMREAD_COLOR);
    ASSERT_EQ(image.size(), shown.size());
    EXPECT_LE(cv::norm(image, shown, cv::NORM_INF), 2) << orientation;
    EXPECT_EQ(reader.notes().size(), 1u);
  }
  // A half turn changes no size: nobody can tell, the stored pixels are the sensor's.
  StillReader reader;
  const auto path = folder.write("half.jpg", with_orientation(jpeg, 3, false));
  expect_bad_input([&] { static_cast<void>(reader.read(path, upright)); }, "half.jpg", "48x32");
}

TEST(StillReader, ConvertsColoursFromTheProfile) {
  const TemporaryFolder folder;
  // Display P3's red, green and blue of half strength, and grey, in sRGB: by the matrix between the
  // two spaces, computed here from their primaries (Lindbloom) through linear light.
  const auto light = [](double code) {
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
  };
  const auto code = [](double value) {
    value = std::clamp(value, 0.0, 1.0);
    return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  };
  const auto space = [](const cmsCIExyYTRIPLE& p) {
    Eigen::Matrix3d xyz;
    int column = 0;
    for (const cmsCIExyY& c : {p.Red, p.Green, p.Blue}) {
      xyz.col(column++) << c.x / c.y, 1, (1 - c.x - c.y) / c.y;
    }
    const Eigen::Vector3d white(0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290);
    return Eigen::Matrix3d(xyz * Eigen::Vector3d(xyz.inverse() * white).asDiagonal());
  };
  const Eigen::Matrix3d srgb_from_p3 = space(kSrgbPrimaries).inverse() * space(kP3Primaries);

  const std::array<cv::Vec3b, 4> colours{cv::Vec3b(90, 120, 180), cv::Vec3b(80, 170, 100),
                                         cv::Vec3b(190, 120, 110), cv::Vec3b(128, 128, 128)};
  for (const cv::Vec3b& bgr : colours) {
    const cv::Mat image(kStillSize.height_px, kStillSize.width_px, CV_8UC3, cv::Scalar(bgr));
    StillReader reader;
    const cv::Mat read = reader.read(
        folder.write("p3.png", with_profile(encoded(image, ".png"), icc_profile(kP3Primaries))),
        kStillSize);
    Eigen::Vector3d rgb;
    for (int i = 0; i < 3; ++i) rgb[i] = light(bgr[2 - i] / 255.0);
    rgb = srgb_from_p3 * rgb;
    // 8 bits out of 8 bits: one step of rounding, one for the profile's fixed-point numbers.
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(read.at<cv::Vec3b>(5, 5)[2 - i], 255 * code(rgb[i]), 2) << cv::Mat(bgr).t();
    }
    ASSERT_EQ(reader.notes().size(), 1u);
    EXPECT_NE(reader.notes()[0].find("sRGB"), std::string::npos);
  }
}

TEST(StillReader, LeavesSrgbAlone) {
  const TemporaryFolder folder;
  const cv::Mat image = corner_image();
  StillReader reader;
  const cv::Mat read = reader.read(
      folder.write("srgb.png", with_profile(encoded(image, ".png"), icc_profile(kSrgbPrimaries))),
      kStillSize);
  EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0);
  EXPECT_TRUE(reader.notes().empty());
  // A profile that nobody can read is said, and changes nothing.
  const cv::Mat other = reader.read(
      folder.write("bad.png", with_profile(encoded(image, ".png"), std::string(200, 'x'))),
      kStillSize);
  EXPECT_EQ(cv::norm(other, image, cv::NORM_INF), 0);
  EXPECT_EQ(reader.notes().size(), 1u);
}

TEST(StillReader, RefusesPicturesCutShort) {
  const TemporaryFolder folder;
  for (const char* ending : {".jpg", ".png"}) {
    const std::string whole = encoded(corner_image(), ending);
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, whole.size() / 2}) {
      const auto path = folder.write("cut" + std::string(ending), whole.substr(0, size));
      StillReader reader;
      expect_bad_input([&] { static_cast<void>(reader.read(path, kStillSize)); }, "cut");
    }
  }
}

TEST(StillReader, ReadsOrRefusesWhateverHeadersSay) {
  const TemporaryFolder folder;
  const std::string jpeg = with_orientation(encoded(corner_image(), ".jpg"), 6, true);
  const std::string png = with_profile(encoded(corner_image(), ".png"), icc_profile(kP3Primaries));
  std::mt19937 random(11);
  for (const std::string& whole : {jpeg, png}) {
    for (int run = 0; run < 600; ++run) {
      std::string altered = whole;
      // Where headers, EXIF and the profile lie.
      const std::size_t part = std::min<std::size_t>(altered.size(), 500);
      for (int i = 0; i < 2; ++i) altered[random() % part] = static_cast<char>(random() % 256);
      const auto path = folder.write("altered", altered);
      StillReader reader;
      try {
        const cv::Mat image = reader.read(path, kStillSize);
        EXPECT_EQ(image.size(), cv::Size(kStillSize.width_px, kStillSize.height_px));
      } catch (const core::Error& error) {
        EXPECT_EQ(error.kind(), core::Error::Kind::bad_input);
      }
    }
  }
}

// A decoder of DICOM that OpenCV asks ended the program over a file of this beginning (found by
// fuzzing); other kinds that OpenCV knows are not promised either.
TEST(StillReader, AsksNoDecoderOfKindsThatAreNotPromised) {
  const TemporaryFolder folder;
  std::string dicom(128, '\0');
  dicom += "DICM";
  dicom.append("\2\0\0\0\xe4\6\7\6\7", 9);
  for (const std::string& bytes : {dicom, std::string("P6 1 1 255 rgb"), std::string("text")}) {
    const auto path = folder.write("picture.png", bytes);
    StillReader reader;
    expect_bad_input([&] { static_cast<void>(reader.read(path, std::nullopt)); },
                     "is no JPEG, PNG");
  }
}

// Each states 30,000 x 30,000 pixels, 2.7 GB, in less than a hundred bytes; found by fuzzing.
TEST(StillReader, TakesNoMemoryForPixelsThatBytesCannotHold) {
  const TemporaryFolder folder;
  const std::string side("\x30\x75\0\0", 4), big_side("\x75\x30", 2);  // 30,000
  const std::string bmp = "BM" + std::string(12, '\0') + std::string("\x28\0\0\0", 4) + side +
                          side + std::string("\1\0\x18\0", 4) + std::string(24, '\0');
  const auto entry = [&](char tag) {
    return std::string{tag, 1} + std::string("\4\0\1\0\0\0", 6) + side;
  };
  const std::string tiff = std::string("II*\0\x08\0\0\0\2\0", 10) + entry('\0') + entry('\1');
  const std::string canvas("\x2f\x75\0", 3);  // less one
  const std::string webp =
      std::string("RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0", 24) + canvas + canvas;
  // Bytes between two segments, which decoders pass over.
  const std::string jpeg = std::string("\xff\xd8\xff\xe0\0\4ab", 8) + "between" +
                           std::string("\xff\xc0\0\x11\x08", 5) + big_side + big_side +
                           std::string("\3\1\x12\0\2\x12\0\3\x12\0\xff\xda\0\x0c\1\0\xff\xd9", 18);
  for (const std::string& bytes : {bmp, tiff, webp, jpeg}) {
    const auto path = folder.write("picture", bytes);
    StillReader reader;
    expect_bad_input([&] { static_cast<void>(reader.read(path, std::nullopt)); }, "cut short");
  }
}

TEST(StillReader, NamesKindsThatAreNotReadByTheirBytes) {
  const TemporaryFolder folder;
  const auto refuse = [&folder](std::string bytes, const char* word) {
    bytes.append(64, '\0');
    const auto path = folder.write("IMG_0001.jpg", bytes);  // whatever the name says
    StillReader reader;
    expect_bad_input([&] { static_cast<void>(reader.read(path, kStillSize)); }, word, "convert");
  };
  const auto box = [](const std::string& brand) {
    std::string bytes("\0\0\0\x18", 4);
    bytes += "ftyp";
    bytes += brand;
    return bytes.append("\0\0\0\0mif1heic", 12);
  };
  refuse(box("heic"), "HEIC");
  refuse(box("avif"), "AVIF");
  refuse("GIF89a", "GIF");
}

TEST(StillReader, SaysWhichColoursOfAPngItPassesOver) {
  const TemporaryFolder folder;
  const std::string png = encoded(corner_image(), ".png");
  const auto notes = [&](const std::string& type, const std::string& data) {
    StillReader reader;
    static_cast<void>(
        reader.read(folder.write("stated.png", with_chunk(png, type, data)), kStillSize));
    return reader.notes().empty() ? std::string() : reader.notes().front();
  };
  // H.273: BT.2020 is 9, PQ 16, Display P3 12, BT.709 1, sRGB's curve 13; full range 1.
  EXPECT_NE(notes("cICP", std::string("\x09\x10\0\x01", 4)).find("BT.2020, transfer PQ"),
            std::string::npos);
  EXPECT_NE(notes("cICP", std::string("\x0c\x0d\0\x01", 4)).find("P3"), std::string::npos);
  EXPECT_NE(notes("cICP", std::string("\x01\x0d\0\0", 4)).find("limited range"), std::string::npos);
  EXPECT_EQ(notes("cICP", std::string("\x01\x0d\0\x01", 4)), "");
  const auto chromaticities = [](const std::vector<int>& steps) {
    std::string bytes;
    for (const int step : steps) {
      for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(step >> shift);
    }
    return bytes;
  };
  const std::string wide = chromaticities({31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000});
  EXPECT_NE(notes("cHRM", wide).find("other primaries"), std::string::npos);
  EXPECT_EQ(notes("cHRM", chromaticities({31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000})),
            "");
}

TEST(StillReader, RefusesTiffOfColoursThatAreNotRgb) {
  const TemporaryFolder folder;
  // One directory of three entries: bits a channel, colours, kind of the numbers; a list of three
  // numbers lies behind it.
  const auto tiff = [](int bits, int colours, int number_kind) {
    std::string bytes("II*\0\x08\0\0\0\x03\0", 10);
    const auto put = [&bytes](std::uint32_t value, int size) {
      for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffU);
    };
    const auto entry = [&put](std::uint32_t tag, std::uint32_t count, std::uint32_t value) {
      put(tag, 2), put(3, 2), put(count, 4), put(value, 4);
    };
    constexpr std::uint32_t behind = 8 + 2 + 3 * 12 + 4;
    entry(0x0102, 3, behind);
    entry(0x0106, 1, static_cast<std::uint32_t>(colours));
    entry(0x0153, 3, behind + 6);
    put(0, 4);
    for (int i = 0; i < 3; ++i) put(static_cast<std::uint32_t>(bits), 2);
    for (int i = 0; i < 3; ++i) put(static_cast<std::uint32_t>(number_kind), 2);
    return bytes;
  };
  const auto refuse = [&](const std::string& bytes, const char* word) {
    const auto path = folder.write("print.tif", bytes);
    expect_bad_input([&] { static_cast<void>(StillReader().read(path, kStillSize)); }, "print.tif",
                     word, "convert it");
  };
  refuse(tiff(8, 5, 1), "CMYK");
  refuse(tiff(8, 8, 1), "Lab");
  refuse(tiff(16, 32803, 1), "raw");
  refuse(tiff(32, 2, 3), "floating point");
  refuse(tiff(32, 2, 1), "16 bits");
  const auto big = folder.write("big.tif", std::string("II+\0\x08\0\0\0", 8));
  expect_bad_input([&] { static_cast<void>(StillReader().read(big, kStillSize)); }, "BigTIFF");
  // What OpenCV writes is read: 16 bits a channel, grey.
  StillReader reader;
  for (const int type : {CV_16UC3, CV_8UC1, CV_16UC1}) {
    const cv::Mat image(kStillSize.height_px, kStillSize.width_px, type, cv::Scalar::all(100));
    EXPECT_FALSE(
        reader.read(folder.write("usual.tif", encoded(image, ".tif")), kStillSize).empty());
  }
}

TEST(CalibrationImages, PassOverWhatOthersLeaveInFolders) {
  const TemporaryFolder folder;
  const std::string jpeg = encoded(corner_image(), ".jpg");
  folder.write("IMG_1.JPG", jpeg);
  folder.write("IMG_2.jpeg", jpeg);
  folder.write("IMG_3.webp", "x");
  folder.write("._IMG_1.JPG", std::string("\0\x05\x16\x07", 4));
  folder.write(".hidden.png", "x");
  folder.write("Thumbs.db", "x");
  std::filesystem::create_directories(folder / "more.jpg");
  const auto images = open_calibration_images(folder.path());
  EXPECT_EQ(images->frame_count(), 3);
}

TEST(CalibrationImages, ComeInTheOrderOfTheirNumbers) {
  const TemporaryFolder folder;
  const std::vector<std::string> in_order{"IMG_9.JPG", "IMG_09.png", "IMG_10.JPG", "IMG_0100.jpg",
                                          "a1b2.jpg",  "a1b10.jpg",  "a10b1.jpg",  "b.jpg"};
  for (const std::string& name : in_order) folder.write(name, "x");
  std::vector<std::string> found;
  for (const auto& path : pictures_in(folder.path())) found.push_back(path.filename().string());
  EXPECT_EQ(found, in_order);
}

TEST(CalibrationImages, NameTheKindThatFillsAFolder) {
  const TemporaryFolder folder;
  folder.write("IMG_1.HEIC", "x");
  expect_bad_input([&] { static_cast<void>(open_calibration_images(folder.path())); }, "HEIC",
                   "convert");
  expect_bad_input([] { static_cast<void>(open_calibration_images("7")); }, "/dev/video7");
}

TEST(ImageFolder, ReadsNamesWithColonsAndPerCents) {
  const TemporaryFolder folder;
  const std::string png = encoded(corner_image(), ".png");
  folder.write("take 10:30/a:b_000.png", png);
  folder.write("take 10:30/a:b_001.png", png);
  const auto frames =
      open_image_folder(folder.path(), "take 10:30/a:b_%03d.png", kStillSize, {}, std::nullopt);
  EXPECT_EQ(frames->frame_count(), 2);
  int count = 0;
  while (frames->next()) ++count;
  EXPECT_EQ(count, 2);
  // Hidden twins of Macs do not count.
  folder.write("take 10:30/._a:b_000.png", "x");
  EXPECT_EQ(
      open_image_folder(folder.path(), "take 10:30/a:b_%03d.png", kStillSize, {}, std::nullopt)
          ->frame_count(),
      2);
}

/// A folder of pictures of 16 bits whose numbers end at `largest`.
void write_deep(const TemporaryFolder& folder, int count, int largest, const char* ending) {
  for (int i = 0; i < count; ++i) {
    cv::Mat image(kStillSize.height_px, kStillSize.width_px, CV_16UC3,
                  cv::Scalar::all(largest / 3));
    image.at<cv::Vec3w>(i, 3)[1] = static_cast<std::uint16_t>(largest);
    folder.write("deep/" + std::to_string(i) + ending, encoded(image, ending));
  }
}

// 65535 / 257 is 255, and 32767.5 / 257 is 127.5: rounded, not cut off.
TEST(StillReader, RoundsSixteenBitsToEight) {
  const TemporaryFolder folder;
  for (const char* ending : {".png", ".tiff"}) {
    cv::Mat deep(1, 2, CV_16UC3, cv::Scalar::all(65535));
    deep.at<cv::Vec3w>(0, 1) = {0, 32767, 257};
    StillReader reader;
    const cv::Mat image = reader.read(
        folder.write(std::string("deep") + ending, encoded(deep, ending)), std::nullopt);
    EXPECT_EQ(image.at<cv::Vec3b>(0, 0), cv::Vec3b(255, 255, 255)) << ending;
    EXPECT_EQ(image.at<cv::Vec3b>(0, 1), cv::Vec3b(0, 127, 1)) << ending;
    EXPECT_TRUE(reader.notes().empty()) << ending;
  }
}

// Numbers of 12 bits in files of 16: many pictures are refused, few are doubted, since one may be
// dark; numbers of 14 bits are doubted only.
TEST(ImageFolder, NumbersOfFewerBitsThanTheirFilesAreToldOrRefused) {
  const auto read = [](int count, int largest, const char* ending) {
    const TemporaryFolder folder;
    write_deep(folder, count, largest, ending);
    const auto frames = open_image_folder(folder.path(), std::string("deep/%d") + ending,
                                          kStillSize, {}, std::nullopt);
    while (frames->next()) {
    }
    const auto notes = frames->report().notes;
    return notes.empty() ? std::string() : notes.front();
  };
  for (const char* ending : {".png", ".tiff"}) {
    expect_bad_input([&] { read(8, 4095, ending); }, "deep", "12 bits", "multiply 16");
    expect_bad_input([&] { read(8, 1023, ending); }, "deep", "10 bits", "multiply 64");
    EXPECT_NE(read(7, 4095, ending).find("12 bits"), std::string::npos);
    EXPECT_NE(read(8, 4096, ending).find("14 bits"), std::string::npos);
    EXPECT_EQ(read(8, 16384, ending), "");
  }
}

/// 8-bit sRGB of one grey value of 16 bits.
int grey_of(LightCurve curve, double signal, WidePrimaries primaries = WidePrimaries::none) {
  const LightConverter converter(curve, primaries);
  const auto value = static_cast<std::uint16_t>(std::lround(65535 * signal));
  const std::uint16_t bgr16[3] = {value, value, value};
  std::uint8_t bgr8[3];
  converter.convert(bgr16, bgr8, 1);
  EXPECT_NEAR(bgr8[0], bgr8[2], 1);  // grey stays grey in any primaries with one white
  EXPECT_NEAR(bgr8[1], bgr8[2], 1);
  return bgr8[1];
}

TEST(LightConverter, SrgbIsItself) {
  const LightConverter converter(LightCurve::srgb, WidePrimaries::none);
  for (int i = 0; i < 256; ++i) {
    const auto value = static_cast<std::uint16_t>(257 * i);
    const std::uint16_t bgr16[3] = {value, 0, 65535};
    std::uint8_t bgr8[3];
    converter.convert(bgr16, bgr8, 1);
    EXPECT_EQ(bgr8[0], i);
    EXPECT_EQ(bgr8[1], 0);
    EXPECT_EQ(bgr8[2], 255);
  }
}

TEST(LightConverter, ReferenceWhiteIsWhite) {
  // ITU-R BT.2408, table 1: reference white, 203 cd/m^2, is 75 % of HLG and 58 % of PQ; the
  // percentages are rounded, half a per cent of signal is 3 % of light, 4 steps of sRGB.
  EXPECT_NEAR(grey_of(LightCurve::hlg, 0.75), 255, 4);
  EXPECT_NEAR(grey_of(LightCurve::pq, 0.58), 255, 4);
  // The same table: a grey card of 18 % (26 cd/m^2) is 38 % of HLG and PQ. 26 / 203 = 0.128 is
  // sRGB 0.394 = 100.5; half a per cent of signal is 4 % of light there, 2 steps.
  EXPECT_NEAR(grey_of(LightCurve::hlg, 0.38), 100.5, 4);
  EXPECT_NEAR(grey_of(LightCurve::pq, 0.38), 100.5, 4);
  EXPECT_EQ(grey_of(LightCurve::hlg, 1), 255);  // clipped
  EXPECT_EQ(grey_of(LightCurve::pq, 0), 0);
  // Linear light 0.2140 is sRGB 0.5.
  EXPECT_NEAR(grey_of(LightCurve::linear, 0.2140), 127.5, 1);
}

TEST(LightConverter, GreyIsGreyInWidePrimaries) {
  for (const double signal : {0.1, 0.5, 0.9}) {
    for (const auto primaries : {WidePrimaries::bt2020, WidePrimaries::display_p3}) {
      EXPECT_NEAR(grey_of(LightCurve::srgb, signal, primaries), 255 * signal, 1);
    }
  }
}

}  // namespace
}  // namespace sheen::capture::test
