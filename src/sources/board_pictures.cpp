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

/// Pictures of one side by their number; of a folder with both sides only those that name this side.
Result<std::map<std::string, fs::path>> pictures_of(const fs::path& folder, const std::string& side) {
  std::vector<fs::path> all, named;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::string ending = entry.path().extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    constexpr const char* kEndings[] = {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp", ".pgm", ".ppm"};
    if (std::find(std::begin(kEndings), std::end(kEndings), ending) == std::end(kEndings)) continue;
    all.push_back(entry.path());
    if (entry.path().stem().string().find(side) != std::string::npos) named.push_back(entry.path());
  }
  if (all.empty()) return refused(fmt::format("{} has no pictures (PNG, JPEG, BMP, TIFF, WebP, PNM)", folder.string()));
  std::map<std::string, fs::path> out;
  for (const fs::path& path : named.empty() ? all : named) {
    std::string number;
    for (const char c : path.stem().string())
      if (std::isdigit(static_cast<unsigned char>(c))) number += c;
    number.insert(0, number.size() < 12 ? 12 - number.size() : 0, '0');
    if (!out.emplace(number, path).second)
      return refused(
          fmt::format("{} and {} have the same number; give each pair its own", out[number].string(), path.string()));
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

Result<BoardPictures> BoardPictures::open(const fs::path& left, const fs::path& right) {
  BoardPictures out;
  std::error_code error;
  if (!fs::is_directory(left, error)) {
    if (fs::is_directory(right, error))
      return refused("one of both is a folder, the other not; give two folders or two videos");
    DUO_TRY_ASSIGN(out.video_, open_pairs(left, right));
    if (out.video_->live()) return refused("cameras give no second look; record the board first, and give the videos");
    if (out.video_->still()) return refused("one pair of pictures is too few; give two folders of them, or two videos");
    return out;
  }
  const fs::path other = right.empty() ? left : right;
  if (!fs::is_directory(other, error)) return refused(fmt::format("{} is no folder, {} is one", other.string(), left.string()));
  DUO_TRY_ASSIGN(auto lefts, pictures_of(left, "left"));
  DUO_TRY_ASSIGN(auto rights, pictures_of(other, "right"));
  if (lefts == rights) return refused(fmt::format("left and right are the same pictures in {}", left.string()));
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
