#include "sources/synthetic/live_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "duoptic/synthetic.h"
#include "duoptic/worker.h"

namespace duo {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kName = "synthetic";
constexpr int kPairs = 60;  // two seconds: as long as people wait for them, and long enough to move an arm
constexpr int kMostPairs = 300;
constexpr std::chrono::nanoseconds kPeriod{1'000'000'000 / 30};

class LiveClip final : public PairSource {
 public:
  explicit LiveClip(SyntheticClip clip)
      : clip_(std::move(clip)),
        size_(clip_.setup().size),
        rig_(clip_.rig()),
        all_(clip_.setup().frames),
        pairs_(static_cast<std::size_t>(all_)) {}

  Result<void> start() {
    DUO_TRY_ASSIGN(renderer_,
                   Worker::start("render the synthetic person", [this](const std::stop_token& stop) { return render(stop); }));
    return {};
  }

  Size size() const override { return size_; }
  std::int64_t count() const override { return 0; }
  bool still() const override { return false; }
  bool live() const override { return true; }
  std::optional<Rig> rig() const override { return rig_; }
  std::int64_t dropped() const override { return dropped_; }
  std::string warning() const override {
    return rendered_ < all_ ? fmt::format("rendering the synthetic person: {} of {} pairs", rendered_.load(), all_)
                            : std::string();
  }

  Result<Next> next(Pair& into) override {
    if (!renderer_.ends_within(std::chrono::milliseconds(500))) return Next::kNothing;
    DUO_TRY(renderer_.join());
    if (!start_) start_ = Clock::now();
    const std::int64_t due = std::max((Clock::now() - *start_) / kPeriod, last_ + 1);
    std::this_thread::sleep_until(*start_ + due * kPeriod);
    dropped_ += due - last_ - 1;
    last_ = due;
    show(due, into);
    return Next::kNew;
  }

 private:
  Result<void> render(const std::stop_token& stop) {
    for (int i = 0; i < all_ && !stop.stop_requested(); ++i) {
      pairs_[static_cast<std::size_t>(i)] = clip_.frame(i).pair;
      rendered_ = i + 1;
    }
    return {};
  }
  void show(std::int64_t number, Pair& into) const {
    const auto turn = static_cast<int>(number % (2 * all_ - 2));
    const Pair& shown = pairs_[static_cast<std::size_t>(std::min(turn, 2 * all_ - 2 - turn))];
    const TimeNs t_ns = (*start_ + number * kPeriod).time_since_epoch() / std::chrono::nanoseconds(1);
    for (Picture Pair::*side : {&Pair::left, &Pair::right}) {
      Picture& picture = into.*side;
      if (picture.pixels.size() != size_) picture.pixels = Image<Rgb8>(size_);
      for (int y = 0; y < size_.height; ++y) std::copy_n((shown.*side).pixels.row(y), size_.width, picture.pixels.row(y));
      picture.t_ns = t_ns;
      picture.sequence = static_cast<std::uint64_t>(number);
    }
    into.sequence = static_cast<std::uint64_t>(number);
  }

  SyntheticClip clip_;
  const Size size_;
  const Rig rig_;
  const int all_;            // pairs
  std::vector<Pair> pairs_;  // the renderer's until it has ended
  std::atomic<int> rendered_ = 0;
  std::optional<Clock::time_point> start_;
  std::int64_t last_ = -1;  // pair that was given
  std::atomic<std::int64_t> dropped_ = 0;
  Worker renderer_;  // last: it uses all of the above
};

}  // namespace

bool is_synthetic_name(std::string_view name) {
  return name.starts_with(kName) && (name.size() == kName.size() || name[kName.size()] == ':');
}

Result<std::unique_ptr<PairSource>> open_live_clip(std::string_view name) {
  SyntheticClipSetup setup{.script = "wave"};
  setup.frames = kPairs;
  if (name.size() > kName.size()) {
    const std::string rest(name.substr(kName.size() + 1));
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    setup.script = rest.substr(0, colon);
    const char* numbers = rest.c_str() + colon;
    int end = 0;
    std::sscanf(numbers, ":%dx%d%n:%d%n", &setup.size.width, &setup.size.height, &end, &setup.frames, &end);
    if (numbers[end] != '\0')
      return Error{ErrorCode::kBadInput, fmt::format("cannot open {}: '{}' is not WIDTHxHEIGHT or WIDTHxHEIGHT:PAIRS; "
                                                     "synthetic:wave:320x240:60 is an example",
                                                     name, rest.substr(colon + 1))};
    if (setup.frames < 2 || setup.frames > kMostPairs)
      return Error{ErrorCode::kBadInput,
                   fmt::format("cannot open {}: {} pairs; choose 2 to {}", name, setup.frames, kMostPairs)};
  }
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  DUO_TRY_ASSIGN(SyntheticClip clip, SyntheticClip::open(setup, threads));
  auto live = std::make_unique<LiveClip>(std::move(clip));
  DUO_TRY(live->start());
  return std::unique_ptr<PairSource>(std::move(live));
}

}  // namespace duo
