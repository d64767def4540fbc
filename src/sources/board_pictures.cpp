#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>

#include "duoptic/calibrate.h"

namespace duo {
namespace fs = std::filesystem;

namespace {

constexpr int kWindow = 10;  // frames of a video, of which the stillest is looked at

Error refused(const std::string& why) { return {ErrorCode::kBadInput, "cannot calibrate: " + why}; }

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The pictures of a folder, without those that the system hides.
Result<std::vector<fs::path>> pictures_in(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    constexpr const char* kEndings[] = {".png",  ".jpg", ".jpeg", ".bmp", ".tif", ".tiff",
                                        ".webp", ".pgm", ".ppm",  ".mpo", ".jps"};
    const bool hidden = entry.path().filename().string().starts_with('.');
    const std::string ending = lower(entry.path().extension().string());
    if (!hidden && std::find(std::begin(kEndings), std::end(kEndings), ending) != std::end(kEndings))
      all.push_back(entry.path());
  }
  std::sort(all.begin(), all.end());
  if (all.empty()) return refused(fmt::format("{} has no pictures (PNG, JPEG, BMP, TIFF, WebP, PNM, MPO)", folder.string()));
  return all;
}

/// Those that name this side; all of them where none names one.
std::vector<fs::path> of_side(const std::vector<fs::path>& all, const std::string& side) {
  std::vector<fs::path> named;
  for (const fs::path& path : all)
    if (lower(path.stem().string()).find(side) != std::string::npos) named.push_back(path);
  return named.empty() ? all : named;
}

/// The last number of a text, without leading zeros; the text itself where there is none.
std::string last_number(const std::string& text) {
  const std::size_t end = text.find_last_of("0123456789");
  if (end == std::string::npos) return text;
  std::size_t begin = end;
  while (begin > 0 && is_digit(text[begin - 1])) --begin;
  const std::string number = text.substr(begin, end + 1 - begin);
  return number.substr(std::min(number.find_first_not_of('0'), number.size() - 1));
}

/// How many characters all stems share at their beginning, or at their end; numbers are not taken apart.
std::size_t shared(const std::vector<std::string>& stems, bool at_end) {
  const auto at = [&](const std::string& stem, std::size_t i) { return stem[at_end ? stem.size() - 1 - i : i]; };
  std::size_t count = stems[0].size();
  for (const std::string& stem : stems) {
    count = std::min(count, stem.size());
    for (std::size_t i = 0; i < count; ++i)
      if (at(stem, i) != at(stems[0], i)) count = i;
  }
  while (count > 0 && is_digit(at(stems[0], count - 1))) --count;
  return count;
}

/// Pictures of one side by what tells them apart: the last number of their names, or, where that is the same in two, what
/// differs within the folder.
Result<std::map<std::string, fs::path>> by_number(const std::vector<fs::path>& pictures) {
  std::map<std::string, fs::path> out;
  for (const fs::path& path : pictures) out.emplace(last_number(path.stem().string()), path);
  if (out.size() == pictures.size()) return out;
  out.clear();
  std::vector<std::string> stems;
  for (const fs::path& path : pictures) stems.push_back(path.stem().string());
  const std::size_t before = shared(stems, false), after = shared(stems, true);
  for (std::size_t i = 0; i < stems.size(); ++i) {
    const std::size_t end = std::max(before, stems[i].size() - std::min(after, stems[i].size()));
    const std::string key = last_number(stems[i].substr(before, end - before));
    if (const auto [other, added] = out.emplace(key, pictures[i]); !added)
      return refused(
          fmt::format("{} and {} have the same number; give each pair its own", other->second.string(), pictures[i].string()));
  }
  return out;
}

/// Mean difference of brightness, on every eighth pixel.
double difference(const Image<Rgb8>& a, const Image<Rgb8>& b) {
  if (a.size() != b.size()) return 1e9;
  std::int64_t sum = 0, count = 0;
  for (int y = 0; y < a.height(); y += 8)
    for (int x = 0; x < a.width(); x += 8, ++count) sum += std::abs(a.at(y, x).g - b.at(y, x).g);
  return count > 0 ? static_cast<double>(sum) / static_cast<double>(count) : 0;
}

}  // namespace

Result<BoardPictures> BoardPictures::open(const fs::path& left, const fs::path& right, const PairWish& wish) {
  BoardPictures out;
  out.wish_ = wish;
  std::error_code error;
  if (!fs::is_directory(left, error)) {
    if (fs::is_directory(right, error))
      return refused("one of both is a folder, the other not; give two folders or two videos");
    DUO_TRY_ASSIGN(out.video_, open_pairs(left, right, wish));
    if (out.video_->live()) return refused("cameras give no second look; record the board first, and give the videos");
    if (out.video_->still()) return refused("one pair of pictures is too few; give two folders of them, or two videos");
    return out;
  }
  const fs::path other = right.empty() ? left : right;
  if (!fs::is_directory(other, error)) return refused(fmt::format("{} is no folder, {} is one", other.string(), left.string()));
  DUO_TRY_ASSIGN(const std::vector<fs::path> all, pictures_in(left));
  const std::vector<fs::path> left_pictures = of_side(all, "left");
  std::vector<fs::path> right_pictures = of_side(all, "right");
  if (right.empty() && left_pictures == right_pictures) {
    for (const fs::path& path : all) out.files_.emplace_back(path, fs::path());
    return out;
  }
  if (!right.empty()) {
    DUO_TRY_ASSIGN(const std::vector<fs::path> others, pictures_in(other));
    right_pictures = of_side(others, "right");
  }
  if (left_pictures == right_pictures) return refused(fmt::format("left and right are the same pictures in {}", left.string()));
  DUO_TRY_ASSIGN(const auto lefts, by_number(left_pictures));
  DUO_TRY_ASSIGN(const auto rights, by_number(right_pictures));
  for (const auto& [number, path] : lefts)
    if (const auto partner = rights.find(number); partner != rights.end()) out.files_.emplace_back(path, partner->second);
  if (out.files_.empty())
    return refused(fmt::format("no picture in {} has the number of one in {}; pairs carry the same number", left.string(),
                               other.string()));
  return out;
}

std::int64_t BoardPictures::count() const {
  return video_ ? video_->count() / kWindow : static_cast<std::int64_t>(files_.size());
}

Result<bool> BoardPictures::next(Pair& into, std::string& name) {
  if (video_) return next_still(into, name);
  if (at_ == files_.size()) return false;
  const auto& [left, right] = files_[at_++];
  if (right.empty()) {
    DUO_TRY_ASSIGN(const auto both, open_pairs(left, {}, wish_));
    DUO_TRY_ASSIGN([[maybe_unused]] const Next next, both->next(into));
    name = left.filename().string();
    return true;
  }
  for (const bool is_left : {true, false}) {
    DUO_TRY_ASSIGN(const auto source, open_source(is_left ? left : right));
    DUO_TRY_ASSIGN([[maybe_unused]] const Next next, source->next(is_left ? into.left : into.right));
  }
  name = left.filename().string() + " " + right.filename().string();
  return true;
}

Result<bool> BoardPictures::next_still(Pair& into, std::string& name) {
  double stillest = 1e12;
  Pair now;
  bool any = false;
  for (int i = 0; i < kWindow; ++i) {
    DUO_TRY_ASSIGN(const Next next, video_->next(now));
    cut_ = cut_ || next == Next::kCut;
    if (next != Next::kNew) break;
    const double moved =
        std::max(difference(now.left.pixels, before_.left.pixels), difference(now.right.pixels, before_.right.pixels));
    before_.left.pixels = now.left.pixels.clone(), before_.right.pixels = now.right.pixels.clone();
    if (moved < stillest) {
      stillest = moved, any = true;
      name = fmt::format("frame {}", frame_);
      std::swap(into, now);
    }
    ++frame_;
  }
  return any;
}

}  // namespace duo
