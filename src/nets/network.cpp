#include "duoptic/network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nets/net_file.h"
#include "nets/net_run.h"
#if DUO_XNNPACK
#include "nets/float_peer.h"
#endif
#if DUO_VULKAN
#include "nets/net_vk.h"
#include "vulkan/choose.h"
#endif

namespace duo {
namespace {

constexpr std::size_t kAnswerValues = 64;
constexpr int kLine = 32;  // values in 64 bytes

/// A byte of slanted waves: every network's input has the range of a byte.
int wave(std::size_t i) { return static_cast<int>(i * 5 % 256); }

/// An input for the network, in its integers.
std::vector<std::int16_t> waves(const Net& net) {
  std::vector<std::int16_t> out(net.tensors[0].count());
  const Range16 range = net.tensors[0].range;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<std::int16_t>(range.low + wave(i) * ((range.high - range.low) / 255));
  return out;
}

int answer_tensor(const Net& net) { return net.outputs.front().tensor; }

std::vector<float> answer_of(const Net& net, ConstTensor16 tensor) {
  std::vector<float> out;
  for (std::size_t i = 0; i < std::min(tensor.count(), kAnswerValues); ++i)
    out.push_back(static_cast<float>(std::ldexp(tensor.data()[i], -net.tensors[answer_tensor(net)].exponent)));
  return out;
}

class OnProcessor final : public Network {
 public:
  OnProcessor(Net net, NetRun::Loops loops, int threads) : net_(std::move(net)), pool_(threads), run_(net_, loops) {}
  Result<void> run() override {
    // By all threads, as a crop fills it.
    std::int16_t* input = run_.input().data();
    pool_.rows(
        static_cast<int>(input_.size()),
        [&](int begin, int end) { std::copy(input_.begin() + begin, input_.begin() + end, input + begin); }, kLine);
    run_.run(pool_);
    return {};
  }
  std::vector<float> answer() const override { return answer_of(net_, run_.tensor(answer_tensor(net_))); }

 private:
  Net net_;
  std::vector<std::int16_t> input_ = waves(net_);
  Pool pool_;
  mutable NetRun run_;
};

#if DUO_XNNPACK
class OnXnnpack final : public Network {
 public:
  static Result<std::unique_ptr<Network>> make(Net net, int threads) {
    auto out = std::make_unique<OnXnnpack>(std::move(net));
    DUO_TRY_ASSIGN(out->peer_, FloatPeer::make(out->net_, threads));
    return std::unique_ptr<Network>(std::move(out));
  }
  explicit OnXnnpack(Net net) : net_(std::move(net)) {
    for (const std::int16_t value : waves(net_))
      input_.push_back(static_cast<float>(std::ldexp(value, -net_.tensors[0].exponent)));
  }
  Result<void> run() override {
    std::copy(input_.begin(), input_.end(), peer_->tensor(0));
    peer_->run();
    return {};
  }
  std::vector<float> answer() const override {
    const float* values = peer_->tensor(answer_tensor(net_));
    return {values, values + std::min(net_.tensors[answer_tensor(net_)].count(), kAnswerValues)};
  }

 private:
  Net net_;
  std::vector<float> input_;
  std::unique_ptr<FloatPeer> peer_;
};
#endif

#if DUO_VULKAN
class OnDevice final : public Network {
 public:
  static Result<std::unique_ptr<Network>> make(Net net, const std::string& wanted) {
    DUO_TRY_ASSIGN(auto instance, vk::Instance::open(vk::Validation::kOff));
    DUO_TRY_ASSIGN(const auto devices, instance->devices());
    DUO_TRY_ASSIGN(const vk::PhysicalDevice chosen, vk::choose_device(devices, wanted));
    DUO_TRY_ASSIGN(auto device, vk::Device::make(instance, chosen));
    auto out = std::make_unique<OnDevice>(std::move(net), std::move(device));
    DUO_TRY_ASSIGN(out->run_, vk::DeviceNet::make(*out->device_, out->net_, 1));
    const auto input = waves(out->net_);
    std::copy(input.begin(), input.end(), out->run_->input(0).data());
    return std::unique_ptr<Network>(std::move(out));
  }
  OnDevice(Net net, std::unique_ptr<vk::Device> device) : net_(std::move(net)), device_(std::move(device)) {}
  Result<void> run() override { return run_->run(); }
  std::vector<float> answer() const override { return answer_of(net_, run_->output(answer_tensor(net_), 0)); }

 private:
  Net net_;
  std::unique_ptr<vk::Device> device_;
  std::unique_ptr<vk::DeviceNet> run_;
};
#endif

}  // namespace

bool has_xnnpack() { return DUO_XNNPACK != 0; }

Result<std::unique_ptr<Network>> open_network(const std::filesystem::path& model, const std::string& engine, int threads) {
  DUO_TRY_ASSIGN(Net net, read_net(model));
  if (engine == "simd" || engine == "ref") {
    const auto loops = engine == "simd" ? NetRun::Loops::kVectors : NetRun::Loops::kPlain;
    return std::unique_ptr<Network>(std::make_unique<OnProcessor>(std::move(net), loops, threads));
  }
#if DUO_XNNPACK
  if (engine == "XNNPACK") return OnXnnpack::make(std::move(net), threads);
#endif
#if DUO_VULKAN
  if (engine == "vulkan") return OnDevice::make(std::move(net), "");
  if (engine.starts_with("vulkan:")) return OnDevice::make(std::move(net), engine.substr(7));
#endif
  return Error{ErrorCode::kUnsupported,
               fmt::format("run {} on \"{}\": this build has no such engine for networks", net.name, engine)};
}

}  // namespace duo
