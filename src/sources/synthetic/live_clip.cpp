#include "sources/synthetic/live_clip.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/cache_file.h"
#include "core/file.h"
#include "duoptic/synthetic.h"
#include "duoptic/worker.h"

namespace duo {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kName = "synthetic";
constexpr int kPairs = 60;  // two seconds: as long as people wait for them, and long enough to move an arm
constexpr int kMostPairs = 300;
constexpr std::chrono::nanoseconds kPeriod{1'000'000'000 / 30};
constexpr int kLarge_px = 480;  // across: pairs of half the size come first, a quarter of the work

using Pairs = std::vector<std::shared_ptr<const Pair>>;

// --- Pictures of an earlier start ------------------------------------------------------------------------------------------

constexpr std::size_t kMostKept = std::size_t{160} << 20;  // bytes

/// What is kept is of this program as it was built: another one may render otherwise.
std::string this_build() {
  Dl_info info{};
  struct stat there {};
  const void* here = reinterpret_cast<const void*>(&this_build);
  const bool named = ::dladdr(here, &info) != 0 && std::strchr(info.dli_fname, '/') != nullptr;
  if (::stat(named ? info.dli_fname : "/proc/self/exe", &there) != 0) return {};
  return fmt::format("duoptic pairs 1, built {}.{:09}, {} bytes\n", there.st_mtim.tv_sec, there.st_mtim.tv_nsec, there.st_size);
}

std::filesystem::path kept_file(const SyntheticClipSetup& setup) {
  return cache_file(fmt::format("synthetic-{}-{}x{}-{}", setup.script, setup.size.width, setup.size.height, setup.frames));
}

std::size_t bytes_of(const Pair& pair) {
  const Size size = pair.left.pixels.size();
  return 2 * sizeof(Rgb8) * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

void keep(const std::filesystem::path& file, const Pairs& pairs) {
  std::string bytes = this_build();
  if (file.empty() || bytes.empty() || pairs.size() * bytes_of(*pairs[0]) > kMostKept) return;
  bytes.reserve(bytes.size() + pairs.size() * bytes_of(*pairs[0]));
  for (const auto& pair : pairs)
    for (const Picture* picture : {&pair->left, &pair->right})
      for (int y = 0; y < picture->pixels.height(); ++y)
        bytes.append(reinterpret_cast<const char*>(picture->pixels.row(y)),
                     sizeof(Rgb8) * static_cast<std::size_t>(picture->pixels.width()));
  write_cache_file(file, bytes);
}

/// False where none are kept, or of another build.
bool read_kept(const std::filesystem::path& file, Size size, Pairs& pairs) {
  const std::string build = this_build();
  if (file.empty() || build.empty()) return false;
  const auto bytes = read_file(file, kMostKept + build.size(), "cache");
  const std::size_t row = sizeof(Rgb8) * static_cast<std::size_t>(size.width);
  if (!bytes || !bytes->starts_with(build) ||
      bytes->size() != build.size() + 2 * pairs.size() * row * static_cast<std::size_t>(size.height))
    return false;
  const char* at = bytes->data() + build.size();
  for (auto& kept : pairs) {
    auto pair = std::make_shared<Pair>();
    for (Picture* picture : {&pair->left, &pair->right}) {
      picture->pixels = Image<Rgb8>(size);
      for (int y = 0; y < size.height; ++y, at += row) std::memcpy(picture->pixels.row(y), at, row);
    }
    kept = std::move(pair);
  }
  return true;
}

// --- The source ------------------------------------------------------------------------------------------------------------

/// Twice as wide and high. The same rig sees it: pixels' centres stay where they are.
Image<Rgb8> doubled(Image<Rgb8> small) {
  Image<Rgb8> out({2 * small.width(), 2 * small.height()});
  const auto mat = [](Image<Rgb8>& image) {
    return cv::Mat(image.height(), image.width(), CV_8UC3, image.row(0),
                   static_cast<std::size_t>(image.stride()) * sizeof(Rgb8));
  };
  const cv::Mat from = mat(small), to = mat(out);
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_LINEAR);
  return out;
}

class LiveClip final : public PairSource {
 public:
  /// `coarse`: the same with pictures of half the size, where there is time for them.
  LiveClip(SyntheticClip clip, std::optional<SyntheticClip> coarse)
      : clip_(std::move(clip)),
        coarse_(std::move(coarse)),
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
    return fine_ < all_
               ? "the synthetic person is shown while she is rendered, slower than she moves, large pictures coarsely at first"
               : "";
  }

  Result<Next> next(Pair& into) override {
    const auto patience = Clock::now() + std::chrono::milliseconds(500);
    while (rendered_ <= last_ + 1 && rendered_ < all_) {  // each is shown when it is there, and no sooner than is due
      if (renderer_.ends_within(std::chrono::milliseconds(0)) && rendered_ < all_) DUO_TRY(renderer_.join());
      if (Clock::now() > patience) return Next::kNothing;
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
      start_.reset();
    }
    if (!start_) start_ = Clock::now() - (last_ + 1) * kPeriod;
    const std::int64_t ready = rendered_, newest = ready < all_ ? ready - 1 : std::numeric_limits<std::int64_t>::max();
    const std::int64_t due = std::clamp<std::int64_t>((Clock::now() - *start_) / kPeriod, last_ + 1, newest);
    std::this_thread::sleep_until(*start_ + due * kPeriod);
    dropped_ += due - last_ - 1;
    last_ = due;
    show(due, into);
    return Next::kNew;
  }

 private:
  Result<void> render(const std::stop_token& stop) {
    const auto file = kept_file(clip_.setup());
    const bool kept = read_kept(file, size_, pairs_);
    if (kept) rendered_ = fine_ = all_;
    for (int i = 0; coarse_ && i < all_ && !kept && !stop.stop_requested(); ++i) {
      auto pair = std::make_shared<Pair>(coarse_->frame(i).pair);
      for (Picture* picture : {&pair->left, &pair->right}) picture->pixels = doubled(std::move(picture->pixels));
      put(i, std::move(pair));
    }
    for (int i = fine_; i < all_ && !stop.stop_requested(); ++i) {
      put(i, std::make_shared<Pair>(clip_.frame(i).pair));
      fine_ = i + 1;
    }
    if (!kept && fine_ == all_) keep(file, pairs_);
    return {};
  }
  void put(int i, std::shared_ptr<const Pair> pair) {
    {
      const std::lock_guard lock(mutex_);
      pairs_[static_cast<std::size_t>(i)] = std::move(pair);
    }
    rendered_ = std::max(rendered_.load(), i + 1);
  }
  void show(std::int64_t number, Pair& into) const {
    const auto turn = static_cast<int>(number % (2 * all_ - 2));
    std::shared_ptr<const Pair> shown;
    {
      const std::lock_guard lock(mutex_);
      shown = pairs_[static_cast<std::size_t>(std::min(turn, 2 * all_ - 2 - turn))];
    }
    const TimeNs t_ns = (*start_ + number * kPeriod).time_since_epoch() / std::chrono::nanoseconds(1);
    for (Picture Pair::*side : {&Pair::left, &Pair::right}) {
      Picture& picture = into.*side;
      if (picture.pixels.size() != size_) picture.pixels = Image<Rgb8>(size_);
      for (int y = 0; y < size_.height; ++y) std::copy_n(((*shown).*side).pixels.row(y), size_.width, picture.pixels.row(y));
      picture.t_ns = t_ns;
      picture.sequence = static_cast<std::uint64_t>(number);
    }
    into.sequence = static_cast<std::uint64_t>(number);
  }

  SyntheticClip clip_;
  std::optional<SyntheticClip> coarse_;
  const Size size_;
  const Rig rig_;
  const int all_;             // pairs
  mutable std::mutex mutex_;  // of pairs_
  Pairs pairs_;               // the first rendered_ of them are there
  std::atomic<int> rendered_ = 0, fine_ = 0;
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
  std::optional<SyntheticClip> coarse;
  if (setup.size.width >= kLarge_px && setup.size.width % 2 == 0 && setup.size.height % 2 == 0) {
    setup.size = {setup.size.width / 2, setup.size.height / 2};
    DUO_TRY_ASSIGN(SyntheticClip half, SyntheticClip::open(setup, threads));
    coarse.emplace(std::move(half));
  }
  auto live = std::make_unique<LiveClip>(std::move(clip), std::move(coarse));
  DUO_TRY(live->start());
  return std::unique_ptr<PairSource>(std::move(live));
}

}  // namespace duo
