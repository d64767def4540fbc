#include "sources/one_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "sources/file_source.h"
#include "sources/two_views.h"

namespace duo {
namespace {

bool is_above(ViewLayout layout) { return layout == ViewLayout::kTopBottom || layout == ViewLayout::kBottomTop; }

Size half(Size both, ViewLayout layout) {
  return is_above(layout) ? Size{both.width, both.height / 2} : Size{both.width / 2, both.height};
}

class Halves final : public FilePairs {
 public:
  Halves(std::unique_ptr<Source> both, std::string name, ViewLayout layout, bool sure)
      : both_(std::move(both)), name_(std::move(name)), layout_(layout), sure_(sure) {}
  Size size() const override { return half(both_->size(), layout_); }
  std::int64_t count() const override { return both_->count(); }
  bool still() const override { return both_->still(); }
  double frame_s() const override { return both_->frame_s(); }
  bool live() const override { return both_->live(); }
  std::int64_t dropped() const override { return both_->dropped(); }
  std::string warning() const override {
    const std::string of_source = both_->warning();
    return of_source + (of_source.empty() || cut_.empty() ? "" : "; ") + cut_;
  }

  Result<std::uint64_t> pass_to(std::uint64_t number) override {
    auto* const file = dynamic_cast<FileSource*>(both_.get());
    if (file == nullptr || file->still() || ended_ || file->indexed_times().size() <= number) return read_to(number, given_);
    DUO_TRY(file->seek(static_cast<std::int64_t>(number)));
    given_ = number;
    return number;
  }
  Result<Next> next(Pair& into) override {
    if (ended_) return *ended_;
    DUO_TRY_ASSIGN(const Next next, both_->next(picture_));
    if (next == Next::kCut || next == Next::kEnd) ended_ = next;
    if (next == Next::kCut) cut_ = fmt::format("{} is cut short or damaged after {} whole pictures", name_, given_);
    if (next != Next::kNew) return next;
    const bool right_first = layout_ == ViewLayout::kRightLeft || layout_ == ViewLayout::kBottomTop;
    take_half(right_first, into.left);
    take_half(!right_first, into.right);
    if (!sure_) DUO_TRY(check(into));
    into.sequence = given_++;
    return Next::kNew;
  }

 private:
  void take_half(bool second, Picture& into) const {
    const Size size = this->size();
    const int x = second && !is_above(layout_) ? size.width : 0, y = second && is_above(layout_) ? size.height : 0;
    if (into.pixels.size() != size) into.pixels = Image<Rgb8>(size);
    for (int v = 0; v < size.height; ++v) std::copy_n(picture_.pixels.row(y + v) + x, size.width, into.pixels.row(v));
    into.jpeg.clear();
    into.coding_noise_q4 = picture_.coding_noise_q4;
    into.t_ns = picture_.t_ns;
    into.sequence = picture_.sequence;
  }

  Result<void> check(const Pair& pair) {
    constexpr std::uint64_t kMostDark = 300;  // pictures without texture: a camera that wakes up, a lens cap
    const SameScene same = show_the_same(pair.left.pixels.view(), pair.right.pixels.view());
    sure_ = same != SameScene::kUnknown || given_ > kMostDark;
    if (same != SameScene::kNo) return {};
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot split {}: its halves have nothing in common, so it is one view; give LEFT and RIGHT, or "
                             "--layout where it has both",
                             name_)};
  }

  std::unique_ptr<Source> both_;
  std::string name_;
  const ViewLayout layout_;
  bool sure_;
  Picture picture_;
  std::optional<Next> ended_;
  std::string cut_;
  std::uint64_t given_ = 0;
};

}  // namespace

Size size_of_both(Size view, std::optional<ViewLayout> layout) {
  return layout && is_above(*layout) ? Size{view.width, 2 * view.height} : Size{2 * view.width, view.height};
}

Result<std::unique_ptr<PairSource>> halve(std::unique_ptr<Source> both, const std::string& name,
                                          std::optional<ViewLayout> layout) {
  const ViewLayout used = layout.value_or(ViewLayout::kSideBySide);
  const Size size = both->size();
  if ((is_above(used) ? size.height : size.width) % 2 != 0)
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot split {}: both views {} need an even {}, it is {}x{}; give LEFT and RIGHT when they are "
                             "two files",
                             name, is_above(used) ? "one above the other" : "side by side", is_above(used) ? "height" : "width",
                             size.width, size.height)};
  return std::unique_ptr<PairSource>(std::make_unique<Halves>(std::move(both), name, used, layout.has_value()));
}

}  // namespace duo
