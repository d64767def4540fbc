// The detector of networks.
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "core/check.h"
#include "core/pool.h"
#include "detectors/find_people.h"
#include "detectors/place.h"
#include "detectors/see_points.h"
#include "detectors/small_hands.h"
#include "duoptic/detector.h"
#include "nets/net_file.h"
#include "nets/net_run.h"
#include "stages/crop_square16/crop_square16.h"
#if DUO_VULKAN
#include "nets/net_vk.h"
#include "vulkan/choose.h"
#include "vulkan/device.h"
#include "vulkan/instance.h"
#endif

namespace duo {
namespace {

#if DUO_VULKAN
using OwnDevice = std::unique_ptr<vk::Device>;
#else
using OwnDevice = std::unique_ptr<int>;  // never one
#endif

/// How networks are run.
struct How {
  bool plain = false;
  OwnDevice device = nullptr;  // null: on the processor
};

constexpr std::size_t kMostAtOnce = 2;  // both views, or two people, in one recording

/// A network that is what its name says: it has the outputs that are read, with their sizes.
class Model {
 public:
  struct Wanted {
    const char* name;
    Size size;
    int channels;
  };
  static Result<std::unique_ptr<Model>> open(const std::filesystem::path& folder, const std::string& name, int side,
                                             std::span<const Wanted> outputs, const How& how) {
    const std::filesystem::path path = folder / (name + ".net");
    auto net = read_net(path);
    if (!net && net.error().code == ErrorCode::kNotFound)
      return Error{ErrorCode::kNotFound,
                   fmt::format("cannot detect people: the network '{}' is not there; run tools/models/make {}, or set "
                               "DUOPTIC_MODELS to the folder that has it",
                               path.string(), name)};
    if (!net) return net.error();
    auto model = std::unique_ptr<Model>(new Model{std::move(*net)});
    const auto other = [&] {
      return Error{ErrorCode::kBadInput, fmt::format("cannot use the network '{}': it is '{}', not '{}'; take the file from "
                                                     "the project again",
                                                     path.string(), model->net_.name, name)};
    };
    const NetTensor& input = model->net_.tensors[0];
    if (model->net_.name != name || !(input.size == Size{side, side}) || input.channels != 3) return other();
    for (const Wanted& output : outputs) {
      const auto tensor = model->net_.output(output.name);
      if (!tensor) return other();
      const NetTensor& found = model->net_.tensors[*tensor];
      if (!(found.size == output.size) || found.channels != output.channels) return other();
      model->outputs_.push_back(*tensor);
    }
#if DUO_VULKAN
    if (how.device != nullptr)
      for (std::size_t pictures = 1; pictures <= kMostAtOnce; ++pictures) {
        DUO_TRY_ASSIGN(auto run, vk::DeviceNet::make(*how.device, model->net_, static_cast<int>(pictures)));
        model->on_device_.push_back(std::move(run));
      }
#endif
    model->run_.emplace(model->net_, how.plain ? NetRun::Loops::kPlain : NetRun::Loops::kVectors);
    return model;
  }

  /// Runs on all looks that can be looked at and calls read(number of the look, number among those run together).
  template <class Read>
  void each(Pool& pool, std::span<const Look> looks, Outside outside, Read read) {
    for (std::size_t begin = 0; begin < looks.size();) {
      std::array<std::size_t, kMostAtOnce> chosen;
      std::size_t count = 0, end = begin;
      for (; end < looks.size() && count < at_once(); ++end)
        if (usable(looks[end].region, looks[end].picture.size())) chosen[count++] = end;
      if (count > 0 && !run(pool, looks, {chosen.data(), count}, outside)) continue;  // again, without the device
      for (std::size_t i = 0; i < count; ++i) read(chosen[i], i);
      begin = end;
    }
  }

  /// Of the last run: an output, in the order in which they were wanted, of one of those run together.
  Result16 output(std::size_t output, std::size_t look) {
    const int tensor = outputs_[output], exponent = net_.tensors[tensor].exponent;
#if DUO_VULKAN
    if (on_device()) return {on_device_[together_ - 1]->output(tensor, static_cast<int>(look)), exponent};
#endif
    DUO_CHECK(look == 0);
    return {run_->tensor(tensor), exponent};
  }

 private:
  explicit Model(Net net) : net_(std::move(net)) {}
#if DUO_VULKAN
  bool on_device() const { return !on_device_.empty() && !lost_; }
  std::size_t at_once() const { return on_device() ? kMostAtOnce : 1; }
#else
  static std::size_t at_once() { return 1; }
#endif

  /// False when the device is lost: the processor goes on, with the same bits.
  bool run(Pool& pool, std::span<const Look> looks, std::span<const std::size_t> chosen, Outside outside) {
    const int low = net_.tensors[0].range.low;  // a black pixel
    const auto crop = [&](std::size_t look, Tensor16 input) {
      simd::crop_square16(pool, looks[look].picture, looks[look].region, outside, low, input);
    };
#if DUO_VULKAN
    if (on_device()) {
      together_ = chosen.size();
      vk::DeviceNet& device_run = *on_device_[together_ - 1];
      for (std::size_t i = 0; i < chosen.size(); ++i) crop(chosen[i], device_run.input(static_cast<int>(i)));
      if (device_run.run()) return true;
      lost_ = true;  // its memory stays: a device that hangs may still write to it
      return false;
    }
#endif
    crop(chosen[0], run_->input());
    run_->run(pool);
    return true;
  }

  Net net_;
  std::vector<int> outputs_;
  std::optional<NetRun> run_;
#if DUO_VULKAN
  std::vector<std::unique_ptr<vk::DeviceNet>> on_device_;  // for one picture, for two, ...
  std::size_t together_ = 1;
  bool lost_ = false;
#endif
};

constexpr int kSides[] = {28, 14, 7};
constexpr Model::Wanted kDetectorOutputs[] = {{"scores_28", {28, 28}, 2}, {"boxes_28", {28, 28}, 24},
                                              {"scores_14", {14, 14}, 2}, {"boxes_14", {14, 14}, 24},
                                              {"scores_7", {7, 7}, 6},    {"boxes_7", {7, 7}, 72}};
constexpr Model::Wanted kBodyOutputs[] = {
    {"points", {1, 1}, 195}, {"heat", {64, 64}, 39}, {"world", {1, 1}, 117}, {"presence", {1, 1}, 1}};
constexpr Model::Wanted kHandOutputs[] = {
    {"points", {1, 1}, 63}, {"world", {1, 1}, 63}, {"presence", {1, 1}, 1}, {"side", {1, 1}, 1}};

class NetDetector final : public Detector {
 public:
  NetDetector(int threads) : pool_(threads) {}
  Result<void> open(const DetectorOptions& options, bool small_hands) {
    const std::filesystem::path folder = options.models.empty() ? models_folder() : options.models;
    constexpr const char* kNames[] = {"body_lite", "body_full", "body_heavy"};
    DUO_TRY(open_device(options));
    DUO_TRY_ASSIGN(finder_, Model::open(folder, "person_detector", kDetectorSide, kDetectorOutputs, how_));
    DUO_TRY_ASSIGN(body_, Model::open(folder, kNames[static_cast<int>(options.body)], kBodySide, kBodyOutputs, how_));
    if (!options.hands) return {};
    const char* hand = small_hands ? "hand_lite" : "hand_full";
    DUO_TRY_ASSIGN(hand_, Model::open(folder, hand, kHandSide, kHandOutputs, how_));
    return {};
  }

  std::span<const FoundPerson> find(View<const Rgb8> picture, Window part) override {
    const int side = std::max(part.width, part.height);  // black around
    const TurnedSquare region = {(2 * part.x + part.width - 1) * 128, (2 * part.y + part.height - 1) * 128, side * 128, 0};
    const Look look{picture, region};
    std::array<DetectorGrid, std::size(kSides)> grids;
    finder_->each(pool_, {&look, 1}, Outside::kBlack, [&](std::size_t, std::size_t at) {
      for (std::size_t i = 0; i < grids.size(); ++i) {
        const Result16 scores = finder_->output(2 * i, at), boxes = finder_->output(2 * i + 1, at);
        grids[i] = {scores.values, boxes.values, scores.exponent, boxes.exponent};
      }
    });
    return find_people_(grids, region);
  }

  void bodies(std::span<const Look> looks, std::span<SeenBody> out) override {
    std::ranges::fill(out, SeenBody());
    body_->each(pool_, looks, Outside::kEdge, [&](std::size_t look, std::size_t at) {
      const auto result = [&](std::size_t i) { return body_->output(i, at); };
      out[look] = see_body(result(0), result(1), result(2), result(3), looks[look].region);
    });
  }

  void hands(std::span<const Look> looks, std::span<SeenHand> out) override {
    std::ranges::fill(out, SeenHand());
    if (!hand_) return;
    hand_->each(pool_, looks, Outside::kEdge, [&](std::size_t look, std::size_t at) {
      const auto result = [&](std::size_t i) { return hand_->output(i, at); };
      out[look] = see_hand(result(0), result(1), result(2), result(3), looks[look].region);
    });
  }
  bool sees_hands() const override { return hand_ != nullptr; }

 private:
  Result<void> open_device(const DetectorOptions& options) {
    how_.plain = options.plain;
    if (!options.device) return {};
#if DUO_VULKAN
    DUO_TRY_ASSIGN(auto instance, vk::Instance::open(vk::Validation::kOff));
    DUO_TRY_ASSIGN(const auto devices, instance->devices());
    DUO_TRY_ASSIGN(const vk::PhysicalDevice chosen, vk::choose_device(devices, *options.device));
    DUO_TRY_ASSIGN(how_.device, vk::Device::make(instance, chosen));
    return {};
#else
    return Error{ErrorCode::kUnsupported, "cannot detect people on a device: this build has no Vulkan; leave out --engine"};
#endif
  }

  Pool pool_;
  How how_;
  std::unique_ptr<Model> finder_, body_, hand_;
  FindPeople find_people_;
};

}  // namespace

std::filesystem::path models_folder() {
  const char* given = std::getenv("DUOPTIC_MODELS");
  if (given != nullptr && *given != '\0') return given;
  static const char kHere = 0;  // where this code was loaded from
  Dl_info loaded{};
  if (dladdr(&kHere, &loaded) != 0 && loaded.dli_fname != nullptr) {
    std::error_code none;  // not lexically: /lib, by which the library may have been found, is a link to /usr/lib
    const auto installed =
        std::filesystem::canonical(std::filesystem::path(loaded.dli_fname).parent_path() / DUO_MODELS_FROM_LIBRARY, none);
    if (!none) return installed;
  }
  return DUO_MODELS;
}

namespace {

Result<std::unique_ptr<Detector>> opened(const DetectorOptions& options, bool small_hands) {
  auto detector = std::make_unique<NetDetector>(options.threads);
  DUO_TRY(detector->open(options, small_hands));
  return std::unique_ptr<Detector>(std::move(detector));
}

}  // namespace

Result<std::unique_ptr<Detector>> make_detector(const DetectorOptions& options) {
  return opened(options, options.body == BodyModel::kLite);
}

Result<std::unique_ptr<Detector>> make_detector_with_small_hands(const DetectorOptions& options) {
  return opened(options, true);
}

}  // namespace duo
