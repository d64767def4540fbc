// open_pairs(): two sources, or one with both views, as one stream of pairs.
#include <fmt/format.h>

#include <string>
#include <utility>

#include "duoptic/one_pair.h"
#include "duoptic/source.h"
#include "sources/camera/camera.h"
#include "sources/camera/modes.h"
#include "sources/file_source.h"
#include "sources/live/live_pairs.h"
#include "sources/one_source.h"
#include "sources/recording.h"
#include "sources/synthetic/live_clip.h"
#include "sources/two_files.h"

namespace duo {
namespace {

std::string size_text(Size size) { return fmt::format("{}x{}", size.width, size.height); }

Result<void> check_sizes(const Source& left, const Source& right, const std::filesystem::path& left_name,
                         const std::filesystem::path& right_name) {
  if (left.size() == right.size()) return {};
  return Error{ErrorCode::kBadInput,
               fmt::format("cannot pair {} with {}: sizes differ, {} and {}; both views need the same size", left_name.string(),
                           right_name.string(), size_text(left.size()), size_text(right.size()))};
}

Error no_layout(const std::filesystem::path& path, const char* why) {
  return {ErrorCode::kUnsupported, fmt::format("cannot use --layout with {}: {}", path.string(), why)};
}

Error no_skew(const std::filesystem::path& path) {
  return {ErrorCode::kUnsupported,
          fmt::format("cannot use --skew-ms with {}: cameras and recordings bring their own times; it is for two videos",
                      path.string())};
}

std::unique_ptr<PairSource> pair_files(TwoViews views, TimeNs skew_ns) {
  if (views.sources[0]->still()) return pair_by_number(std::move(views), std::nullopt);
  return pair_by_time(std::move(views), skew_ns);
}

/// Both views in one source: in files of their own kind, as two tracks or two pictures, or as halves.
Result<std::unique_ptr<PairSource>> open_both(const std::filesystem::path& path, const PairWish& wish) {
  if (wish.skew_ns != 0) return no_skew(path);
  constexpr char kApart[] = "it holds two views apart from each other, the first is the left one";
  if (is_synthetic_name(path.string())) {
    if (wish.layout) return no_layout(path, kApart);
    return open_live_clip(path.string());
  }
  CameraWish of_both = wish.cameras;  // a camera with both views gives them in one picture
  of_both.size = size_of_both(of_both.size, wish.layout);
  DUO_TRY_ASSIGN(auto source, open_source(path, of_both));
  const auto* file = dynamic_cast<const FileSource*>(source.get());
  DUO_TRY_ASSIGN(std::optional<RecordingHead> recording,
                 file != nullptr ? read_recording_head(path) : Result<std::optional<RecordingHead>>(std::nullopt));
  const bool apart = recording || (file != nullptr && file->views() == 2);
  if (!apart) return halve(std::move(source), path.string(), wish.layout ? wish.layout : file ? file->layout() : std::nullopt);
  if (wish.layout) return no_layout(path, kApart);
  DUO_TRY_ASSIGN(auto left, open_view(path, 0));
  DUO_TRY_ASSIGN(auto right, open_view(path, 1));
  DUO_TRY(check_sizes(*left, *right, path, path));
  TwoViews views{{std::move(left), std::move(right)}, {path.string(), path.string()}};
  if (recording && recording->ours) return pair_by_number(std::move(views), std::move(*recording));
  return pair_files(std::move(views), 0);
}

/// One pair, as a stream.
class OnePair final : public PairSource {
 public:
  explicit OnePair(Pair pair) : pair_(std::move(pair)), size_(pair_.left.pixels.size()) {}
  Size size() const override { return size_; }
  std::int64_t count() const override { return 1; }
  bool still() const override { return true; }
  Result<Next> next(Pair& into) override {
    if (given_) return Next::kEnd;
    given_ = true;
    into = std::move(pair_);
    return Next::kNew;
  }
  std::string warning() const override { return {}; }

 private:
  Pair pair_;
  Size size_;
  bool given_ = false;
};

}  // namespace

Result<std::unique_ptr<PairSource>> open_pairs(const std::filesystem::path& left, const std::filesystem::path& right,
                                               const PairWish& wish) {
  if (right.empty()) return open_both(left, wish);
  if (wish.layout) return no_layout(right, "it is for one source with both views, and RIGHT is given");
  if (is_camera_name(left.string()) && is_camera_name(right.string())) {
    if (wish.skew_ns != 0) return no_skew(left);
    DUO_TRY_ASSIGN(auto both, open_cameras(linux_calls(), left.string(), right.string(), wish.cameras));
    return make_live_pairs(std::move(both[0]), std::move(both[1]));
  }
  DUO_TRY_ASSIGN(auto left_source, open_source(left, wish.cameras));
  DUO_TRY_ASSIGN(auto right_source, open_source(right, wish.cameras));
  if (left_source->live() != right_source->live())
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot pair {} with {}: one is live, the other a file", left.string(), right.string())};
  if (left_source->still() != right_source->still())
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot pair {} with {}: one is a picture, the other a video", left.string(), right.string())};
  DUO_TRY(check_sizes(*left_source, *right_source, left, right));
  if (wish.skew_ns != 0 && (left_source->live() || left_source->still())) return no_skew(left);
  if (left_source->live()) return make_live_pairs(std::move(left_source), std::move(right_source));
  return pair_files({{std::move(left_source), std::move(right_source)}, {left.string(), right.string()}}, wish.skew_ns);
}

std::unique_ptr<PairSource> one_pair(Pair pair) { return std::make_unique<OnePair>(std::move(pair)); }

}  // namespace duo
