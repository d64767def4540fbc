// The detector of networks.
#include <fmt/format.h>

#include <cstdlib>

#include "core/pool.h"
#include "detectors/find_people.h"
#include "detectors/place.h"
#include "detectors/see_points.h"
#include "duoptic/detector.h"
#include "nets/net_file.h"
#include "nets/net_run.h"
#include "stages/crop_square16/crop_square16.h"

namespace duo {
namespace {

/// A network that is what its name says: it has the outputs that are read, with their sizes.
class Model {
 public:
  struct Wanted {
    const char* name;
    Size size;
    int channels;
  };
  static Result<std::unique_ptr<Model>> open(const std::filesystem::path& folder, const std::string& name, int side,
                                             std::span<const Wanted> outputs, bool plain) {
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
    model->run_.emplace(model->net_, plain ? NetRun::Loops::kPlain : NetRun::Loops::kVectors);
    return model;
  }

  void look(Pool& pool, const Look& look, Outside outside) {
    const int low = net_.tensors[0].range.low;  // a black pixel
    simd::crop_square16(pool, look.picture, look.region, outside, low, run_->input());
    run_->run(pool);
  }
  /// In the order in which they were wanted.
  Result16 output(std::size_t i) { return {run_->tensor(outputs_[i]), net_.tensors[outputs_[i]].exponent}; }

 private:
  explicit Model(Net net) : net_(std::move(net)) {}
  Net net_;
  std::vector<int> outputs_;
  std::optional<NetRun> run_;
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
  Result<void> open(const DetectorOptions& options) {
    const std::filesystem::path folder = options.models.empty() ? models_folder() : options.models;
    constexpr const char* kNames[] = {"body_lite", "body_full", "body_heavy"};
    DUO_TRY_ASSIGN(finder_, Model::open(folder, "person_detector", kDetectorSide, kDetectorOutputs, options.plain));
    DUO_TRY_ASSIGN(body_, Model::open(folder, kNames[static_cast<int>(options.body)], kBodySide, kBodyOutputs, options.plain));
    if (!options.hands) return {};
    const char* hand = options.body == BodyModel::kLite ? "hand_lite" : "hand_full";
    DUO_TRY_ASSIGN(hand_, Model::open(folder, hand, kHandSide, kHandOutputs, options.plain));
    return {};
  }

  std::span<const FoundPerson> find(View<const Rgb8> picture, Window part) override {
    const int side = std::max(part.width, part.height);  // black around
    const TurnedSquare region = {(2 * part.x + part.width - 1) * 128, (2 * part.y + part.height - 1) * 128, side * 128, 0};
    finder_->look(pool_, {picture, region}, Outside::kBlack);
    std::array<DetectorGrid, std::size(kSides)> grids;
    for (std::size_t i = 0; i < grids.size(); ++i) {
      const Result16 scores = finder_->output(2 * i), boxes = finder_->output(2 * i + 1);
      grids[i] = {scores.values, boxes.values, scores.exponent, boxes.exponent};
    }
    return find_people_(grids, region);
  }

  void bodies(std::span<const Look> looks, std::span<SeenBody> out) override {
    for (std::size_t i = 0; i < looks.size(); ++i) {
      out[i] = {};
      if (!usable(looks[i].region, looks[i].picture.size())) continue;
      body_->look(pool_, looks[i], Outside::kEdge);
      out[i] = see_body(body_->output(0), body_->output(1), body_->output(2), body_->output(3), looks[i].region);
    }
  }

  void hands(std::span<const Look> looks, std::span<SeenHand> out) override {
    for (std::size_t i = 0; i < looks.size(); ++i) {
      out[i] = {};
      if (!hand_ || !usable(looks[i].region, looks[i].picture.size())) continue;
      hand_->look(pool_, looks[i], Outside::kEdge);
      out[i] = see_hand(hand_->output(0), hand_->output(1), hand_->output(2), hand_->output(3), looks[i].region);
    }
  }
  bool sees_hands() const override { return hand_ != nullptr; }

 private:
  Pool pool_;
  std::unique_ptr<Model> finder_, body_, hand_;
  FindPeople find_people_;
};

}  // namespace

std::filesystem::path models_folder() {
  const char* given = std::getenv("DUOPTIC_MODELS");
  return given != nullptr && *given != '\0' ? given : DUO_MODELS;
}

Result<std::unique_ptr<Detector>> make_detector(const DetectorOptions& options) {
  auto detector = std::make_unique<NetDetector>(options.threads);
  DUO_TRY(detector->open(options));
  return std::unique_ptr<Detector>(std::move(detector));
}

}  // namespace duo
