// SPDX-License-Identifier: MIT
#include "capture/calibration/calibration_images.h"

#include "capture/source/image_facts.h"
#include "capture/source/still_reader.h"
#include "capture/source/video_source.h"
#include "core/diagnostics/error.h"
#include "core/text/lower_case.h"
#include "core/text/natural_order.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace sheen::capture {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> kImageEndings{".jpg", ".jpeg", ".png", ".bmp",
                                                        ".tif", ".tiff", ".webp"};
constexpr std::array<std::string_view, 3> kRecordings{"frames.avi", "frames.mkv", "frames.mp4"};

bool is_hidden(const fs::path& path) {
  return path.filename().string().starts_with('.');
}

/// Whatever images a folder holds, by name; the size of the first binds the others.
class ImageFolder : public FrameSource {
 public:
  explicit ImageFolder(const fs::path& folder) : folder_(folder), files_(pictures_in(folder)) {}

  std::optional<Frame> next() override {
    if (next_ == files_.size()) {
      reader_.check_all(folder_);
      return std::nullopt;
    }
    Frame frame;
    frame.image = reader_.read(files_[next_], std::nullopt);
    frame.index = static_cast<int>(next_++);
    frame.time_s = frame.index;
    return frame;
  }

  [[nodiscard]] std::optional<int> frame_count() const override {
    return static_cast<int>(files_.size());
  }

  [[nodiscard]] SourceReport report() const override { return {0, reader_.notes()}; }

 private:
  fs::path folder_;
  std::vector<fs::path> files_;
  std::size_t next_ = 0;
  StillReader reader_;
};

std::unique_ptr<FrameSource> open_whole_video(const fs::path& path) {
  return open_video(path, stored_video_size(path), {}, std::nullopt);
}

}  // namespace

bool is_picture_name(const fs::path& path) {
  const std::string ending = core::lower_case(path.extension().string());
  return std::find(kImageEndings.begin(), kImageEndings.end(), ending) != kImageEndings.end();
}

std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::optional<UnreadableKind> other;
  std::error_code fault;
  for (fs::directory_iterator entry(folder, fault), last; !fault && entry != last;
       entry.increment(fault)) {
    // Macs leave ._IMG_0001.JPG beside IMG_0001.JPG; hidden files are nobody's photographs.
    if (!entry->is_regular_file(fault) || is_hidden(entry->path())) continue;
    if (is_picture_name(entry->path())) files.push_back(entry->path());
    if (!other) other = unreadable_ending(entry->path());
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return core::comes_before(a.filename().string(), b.filename().string());
  });
  if (files.empty() && other) {
    throw core::bad_input(folder, "holds pictures of " + other->name + " only, which are not read",
                          other->remedy);
  }
  if (files.empty()) {
    throw core::bad_input(folder, "holds no images",
                          "name a folder of .jpg or .png files, or a session folder with its "
                          "session.json");
  }
  return files;
}

std::unique_ptr<FrameSource> open_calibration_images(const fs::path& source) {
  std::error_code no_throw;
  if (fs::is_regular_file(source, no_throw)) return open_whole_video(source);
  if (!fs::is_directory(source, no_throw)) {
    const std::string name = source.string();
    const bool is_number =
        !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
    throw core::bad_input(
        source, "there is no such video or folder",
        is_number ? "check the path; a camera is named /dev/video" + name : "check the path");
  }
  if (fs::is_regular_file(source / "session.json", no_throw)) {
    for (const std::string_view name : kRecordings) {
      if (fs::is_regular_file(source / name, no_throw)) return open_whole_video(source / name);
    }
    if (fs::is_directory(source / "images", no_throw)) {
      return std::make_unique<ImageFolder>(source / "images");
    }
  }
  return std::make_unique<ImageFolder>(source);
}

}  // namespace sheen::capture
