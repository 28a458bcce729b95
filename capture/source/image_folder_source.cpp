// SPDX-License-Identifier: MIT
#include "capture/source/image_folder_source.h"

#include "capture/calibration/calibration_images.h"
#include "capture/source/image_check.h"
#include "capture/source/image_facts.h"
#include "capture/source/still_reader.h"
#include "core/diagnostics/error.h"
#include "core/text/number.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

namespace sheen::capture {
namespace {

constexpr std::size_t kMaxDigits = 9;

/// Numbers of all images that the pattern names.
std::set<int> find_numbers(const std::filesystem::path& folder, const NumberedName& name) {
  std::set<int> numbers;
  std::error_code fault;
  for (std::filesystem::directory_iterator entry(folder, fault), last; !fault && entry != last;
       entry.increment(fault)) {
    if (const auto number = name.number_in(entry->path().filename().string())) {
      numbers.insert(*number);
    }
  }
  return numbers;
}

/// The pattern of a name whose last digits are its number: IMG_0457.JPG -> IMG_%04d.JPG.
std::string pattern_of(const std::string& file_name) {
  const std::size_t last = file_name.find_last_of("0123456789");
  if (last == std::string::npos) return {};
  const std::size_t before = file_name.find_last_not_of("0123456789", last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  const std::size_t digits = last + 1 - first;
  const std::string width =
      file_name[first] == '0' && digits > 1 ? "0" + std::to_string(digits) : std::string();
  return file_name.substr(0, first) + "%" + width + "d" + file_name.substr(last + 1);
}

/// No file has a name of the pattern: says what the folder holds instead.
[[noreturn]] void refuse_other_names(const std::filesystem::path& session_folder,
                                     const NumberedName& name) {
  const std::filesystem::path folder = session_folder / name.folder();
  std::error_code fault;
  if (!std::filesystem::is_directory(folder, fault)) {
    throw core::bad_input(folder, "there is no such folder", "correct \"images\" in session.json");
  }
  std::string first;
  for (std::filesystem::directory_iterator entry(folder, fault), last; !fault && entry != last;
       entry.increment(fault)) {
    const std::string file = entry->path().filename().string();
    if (file.starts_with('.') || !is_picture_name(file)) continue;
    if (first.empty() || file < first) first = file;
  }
  if (first.empty()) {
    throw core::bad_input(session_folder / name.at(0), "there is no such image, and no other",
                          "number the images from 0 or 1");
  }
  const std::string pattern = pattern_of(first);
  throw core::bad_input(
      session_folder / name.at(0),
      "there is no image of this name or number; the folder holds " + core::quotable(first),
      pattern.empty() ? "number the images from 0 or 1"
                      : "write \"images\": \"" + core::quotable(name.folder() + pattern) +
                            "\" in session.json");
}

class ImageFolderSource : public FrameSource {
 public:
  ImageFolderSource(std::filesystem::path session_folder, NumberedName name, ImageSize size,
                    FrameRange range, double fps)
      : session_folder_(std::move(session_folder)),
        name_(std::move(name)),
        size_(size),
        range_(range),
        fps_(fps) {
    const auto [first, count] = find_images(session_folder_, name_);
    check_range(session_folder_ / name_.folder(), range_, count);
    first_ = first;
    next_ = range_.start;
    end_ = std::min(count, range_.end.value_or(count));
    waiting_ = read();
  }

  std::optional<Frame> next() override {
    auto frame = std::exchange(waiting_, std::nullopt);
    return frame ? frame : read();
  }

  bool skip() override {
    if (std::exchange(waiting_, std::nullopt)) return true;
    if (next_ >= end_) return false;
    ++next_;
    return true;
  }

  [[nodiscard]] std::optional<int> frame_count() const override { return end_ - range_.start; }

  [[nodiscard]] SourceReport report() const override { return {0, reader_.notes()}; }

 private:
  std::optional<Frame> read() {
    if (next_ >= end_) {
      reader_.check_all(session_folder_ / name_.folder());
      return std::nullopt;
    }
    cv::Mat image = reader_.read(session_folder_ / name_.at(first_ + next_), size_);
    const int index = next_++;
    Frame frame{std::move(image), index / fps_, index};
    frame.spacing_s = 1 / fps_;
    return frame;
  }

  std::filesystem::path session_folder_;
  NumberedName name_;
  ImageSize size_;
  FrameRange range_;
  double fps_;
  int first_ = 0;  // number of the first image
  int next_ = 0;
  int end_ = 0;
  StillReader reader_;
  std::optional<Frame> waiting_;
};

}  // namespace

std::optional<NumberedName> NumberedName::parse(const std::string& pattern) {
  NumberedName name;
  const std::size_t slash = pattern.rfind('/');
  const std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
  name.folder_ = pattern.substr(0, begin);
  const std::string file = pattern.substr(begin);
  const std::size_t percent = file.find('%');
  const std::size_t letter = file.find('d', percent);
  if (percent == std::string::npos || letter == std::string::npos) return std::nullopt;

  // Between them only a width such as 04.
  const std::string width = file.substr(percent + 1, letter - percent - 1);
  if (!std::all_of(width.begin(), width.end(), [](char c) { return c >= '0' && c <= '9'; }) ||
      width.size() > 2) {
    return std::nullopt;
  }
  name.digits_ = width.empty() ? 0 : static_cast<std::size_t>(std::stoi(width));
  name.prefix_ = file.substr(0, percent);
  name.suffix_ = file.substr(letter + 1);
  const bool has_other = (name.folder_ + name.suffix_).find('%') != std::string::npos;
  if (has_other || name.digits_ > kMaxDigits) return std::nullopt;
  return name;
}

std::string NumberedName::at(int number) const {
  const std::string digits = std::to_string(number);
  const std::string zeros(digits_ - std::min(digits_, digits.size()), '0');
  return folder_ + prefix_ + zeros + digits + suffix_;
}

std::optional<int> NumberedName::number_in(const std::string& file_name) const {
  if (file_name.size() <= prefix_.size() + suffix_.size() || !file_name.starts_with(prefix_) ||
      !file_name.ends_with(suffix_)) {
    return std::nullopt;
  }
  const char* begin = file_name.data() + prefix_.size();
  const char* end = file_name.data() + file_name.size() - suffix_.size();
  int number = 0;
  const auto [stop, status] = std::from_chars(begin, end, number);
  // Writing it again tells a name of this form from 7.png among 0007.png.
  if (status != std::errc() || stop != end || number < 0 || at(number) != folder_ + file_name) {
    return std::nullopt;
  }
  return number;
}

NumberedImages find_images(const std::filesystem::path& session_folder, const NumberedName& name) {
  if (const auto kind = unreadable_ending(name.at(0))) {
    throw core::bad_input(session_folder / name.at(0),
                          "pictures of " + kind->name + " are not read", kind->remedy);
  }
  const std::set<int> numbers = find_numbers(session_folder / name.folder(), name);
  if (numbers.empty()) refuse_other_names(session_folder, name);
  if (*numbers.begin() > 1) {
    throw core::bad_input(session_folder / name.at(*numbers.begin()),
                          "is the first image: none has the number 0 or 1",
                          "number the images from 0 or 1");
  }
  const NumberedImages images{*numbers.begin(), static_cast<int>(numbers.size())};
  if (*numbers.rbegin() - images.first == images.count - 1) return images;
  int missing = images.first;
  while (numbers.contains(missing)) ++missing;
  throw core::bad_input(session_folder / name.at(missing), "this image is missing",
                        "number the images without gaps");
}

std::unique_ptr<FrameSource> open_image_folder(const std::filesystem::path& session_folder,
                                               const std::string& pattern, const ImageSize& size,
                                               const FrameRange& range, std::optional<double> fps) {
  const auto name = NumberedName::parse(pattern);
  if (!name) {
    throw core::bad_input(session_folder / pattern, "is no pattern with one number",
                          "write it like images/%04d.png");
  }
  return std::make_unique<ImageFolderSource>(session_folder, *name, size, range, fps.value_or(1));
}

}  // namespace sheen::capture
