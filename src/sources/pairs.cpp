// open_pairs(): two sources, or one with both views as two tracks or side by side, as one stream of pairs.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "duoptic/source.h"
#include "sources/camera/camera.h"
#include "sources/camera/modes.h"
#include "sources/live/live_pairs.h"
#include "sources/recording.h"
#include "sources/synthetic/live_clip.h"
#include "sources/video.h"

namespace duo {
namespace {

std::string cut_text(const std::string& name, std::uint64_t pictures) {
  return fmt::format("{} is cut short or damaged after {} whole pictures", name, pictures);
}

class TwoFiles final : public PairSource {
 public:
  TwoFiles(std::unique_ptr<Source> left, std::unique_ptr<Source> right, std::string left_name, std::string right_name)
      : left_(std::move(left)), right_(std::move(right)), names_{std::move(left_name), std::move(right_name)} {}
  /// Both tracks of a recording.
  TwoFiles(std::unique_ptr<Source> left, std::unique_ptr<Source> right, const std::string& name, RecordingHead head)
      : TwoFiles(std::move(left), std::move(right), name, name) {
    head_ = std::move(head);
  }
  Size size() const override { return left_->size(); }
  std::int64_t count() const override { return head_ ? head_->pairs : std::min(left_->count(), right_->count()); }
  std::optional<Rig> rig() const override { return head_ ? head_->rig : std::nullopt; }
  bool still() const override { return left_->still(); }
  double frame_s() const override { return left_->frame_s(); }
  std::string warning() const override { return warning_; }

  Result<Next> next(Pair& into) override {
    DUO_TRY_ASSIGN(const Next left, left_->next(into.left));
    DUO_TRY_ASSIGN(const Next right, right_->next(into.right));
    into.sequence = given_;
    if (left == Next::kNew && right == Next::kNew) {
      ++given_;
      return Next::kNew;
    }
    if (left == Next::kCut || right == Next::kCut) {
      warning_ = cut_text(names_[left == Next::kCut ? 0 : 1], given_);
      return Next::kCut;
    }
    if (left != right)
      warning_ = fmt::format("{} ends after {} pictures, the other file goes on", names_[left == Next::kEnd ? 0 : 1], given_);
    return Next::kEnd;
  }

 private:
  std::unique_ptr<Source> left_, right_;
  std::string names_[2];
  std::optional<RecordingHead> head_;
  std::string warning_;
  std::uint64_t given_ = 0;
};

class SideBySide final : public PairSource {
 public:
  SideBySide(std::unique_ptr<Source> both, std::string name) : both_(std::move(both)), name_(std::move(name)) {}
  Size size() const override { return {both_->size().width / 2, both_->size().height}; }
  std::int64_t count() const override { return both_->count(); }
  bool still() const override { return both_->still(); }
  double frame_s() const override { return both_->frame_s(); }
  bool live() const override { return both_->live(); }
  std::int64_t dropped() const override { return both_->dropped(); }
  std::string warning() const override { return both_->live() ? both_->warning() : warning_; }

  Result<Next> next(Pair& into) override {
    DUO_TRY_ASSIGN(const Next next, both_->next(picture_));
    if (next == Next::kCut) warning_ = cut_text(name_, given_);
    if (next != Next::kNew) return next;
    take_half(0, into.left);
    take_half(size().width, into.right);
    into.sequence = given_++;
    return Next::kNew;
  }

 private:
  void take_half(int x, Picture& into) const {
    if (into.pixels.size() != size()) into.pixels = Image<Rgb8>(size());
    for (int y = 0; y < size().height; ++y) std::copy_n(picture_.pixels.row(y) + x, size().width, into.pixels.row(y));
    into.jpeg.clear();
    into.t_ns = picture_.t_ns;
    into.sequence = picture_.sequence;
  }

  std::unique_ptr<Source> both_;
  std::string name_;
  Picture picture_;
  std::string warning_;
  std::uint64_t given_ = 0;
};

std::string size_text(Size size) { return fmt::format("{}x{}", size.width, size.height); }

Result<void> check_sizes(const Source& left, const Source& right, const std::filesystem::path& left_name,
                         const std::filesystem::path& right_name) {
  if (left.size() == right.size()) return {};
  return Error{ErrorCode::kBadInput,
               fmt::format("cannot pair {} with {}: sizes differ, {} and {}; both views need the same size", left_name.string(),
                           right_name.string(), size_text(left.size()), size_text(right.size()))};
}

}  // namespace

Result<std::unique_ptr<PairSource>> open_pairs(const std::filesystem::path& left, const std::filesystem::path& right,
                                               const CameraWish& wish) {
  if (right.empty() && is_synthetic_name(left.string())) return open_live_clip(left.string());
  if (is_camera_name(left.string()) && is_camera_name(right.string())) {
    DUO_TRY_ASSIGN(auto both, open_cameras(linux_calls(), left.string(), right.string(), wish));
    return make_live_pairs(std::move(both[0]), std::move(both[1]));
  }
  DUO_TRY_ASSIGN(auto left_source, open_source(left, wish));
  const Size size = left_source->size();
  if (right.empty()) {
    DUO_TRY_ASSIGN(std::optional<RecordingHead> recording, read_recording_head(left));
    if (recording) {
      DUO_TRY_ASSIGN(left_source, open_video(left, 0));
      DUO_TRY_ASSIGN(auto right_source, open_video(left, 1));
      DUO_TRY(check_sizes(*left_source, *right_source, left, left));
      return std::unique_ptr<PairSource>(
          std::make_unique<TwoFiles>(std::move(left_source), std::move(right_source), left.string(), std::move(*recording)));
    }
    if (size.width % 2 != 0)
      return Error{ErrorCode::kBadInput,
                   fmt::format("cannot split {}: both views side by side need an even width, it is {}; give LEFT "
                               "and RIGHT when they are two files",
                               left.string(), size_text(size))};
    return std::unique_ptr<PairSource>(std::make_unique<SideBySide>(std::move(left_source), left.string()));
  }
  DUO_TRY_ASSIGN(auto right_source, open_source(right, wish));
  if (left_source->live() != right_source->live())
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot pair {} with {}: one is live, the other a file", left.string(), right.string())};
  if (left_source->still() != right_source->still())
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot pair {} with {}: one is a picture, the other a video", left.string(), right.string())};
  DUO_TRY(check_sizes(*left_source, *right_source, left, right));
  if (left_source->live()) return make_live_pairs(std::move(left_source), std::move(right_source));
  return std::unique_ptr<PairSource>(
      std::make_unique<TwoFiles>(std::move(left_source), std::move(right_source), left.string(), right.string()));
}

}  // namespace duo
