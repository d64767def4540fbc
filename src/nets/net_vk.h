// A network on a device, for several pictures at once.
#pragma once

#include <memory>
#include <vector>

#include "nets/memory_plan.h"
#include "nets/net.h"
#include "stages/add16/add16_vk.h"
#include "stages/conv_first16/conv_first16_vk.h"
#include "stages/depth_to_space16/depth_to_space16_vk.h"
#include "stages/depthwise16/depthwise16_vk.h"
#include "stages/matmul16/matmul16_vk.h"
#include "stages/maxpool2x16/maxpool2x16_vk.h"
#include "stages/resize2x16/resize2x16_vk.h"
#include "stages/sum_pixels16/sum_pixels16_vk.h"
#include "vulkan/recorder.h"
#include "vulkan/tensor.h"

namespace duo::vk {

/// The kernels and memory of a network; all layers in the order of the network are one recording. Both the network and the
/// device must outlive it.
///
/// Exact  the bits of NetRun, whatever the device and however many pictures
class DeviceNet {
 public:
  /// `pictures`: so many are run at once, at least one.
  ///
  /// Errors  the device lacks memory, or the driver refuses a kernel
  static Result<std::unique_ptr<DeviceNet>> make(Device& device, const Net& net, int pictures);
  DeviceNet(const DeviceNet&) = delete;
  DeviceNet& operator=(const DeviceNet&) = delete;

  int pictures() const { return pictures_; }
  /// To be filled before run().
  Tensor16 input(int picture);
  /// Sends the inputs, runs all layers, fetches the outputs: one submission, which waits. Nothing is allocated.
  ///
  /// Errors  the device is lost, or does not answer in time
  Result<void> run() { return recorder_->run(); }
  /// A tensor that is an output; stays until the next run.
  ConstTensor16 output(int tensor, int picture) const;

  /// Where a tensor lies on the device. Inputs and outputs have memory of their own: the input may be written, and outputs
  /// read, by other kernels of a recording.
  Tensors16 on_device(int tensor) const;
  /// All layers, from the input on the device to the outputs there.
  void record(Recorder& recorder) const;

 private:
  DeviceNet(const Net& net, int pictures) : net_(&net), pictures_(pictures), plan_(plan_memory(net)) {}
  Result<void> make_kernels(const Device& device);
  Result<void> make_constants(Device& device);
  Result<void> make_memory(const Device& device);
  Result<void> record_run(Device& device);

  const Net* net_;
  int pictures_;
  MemoryPlan plan_;
  std::vector<std::size_t> constants_at_;        // of each layer, in words
  std::vector<std::ptrdiff_t> output_at_;        // of each tensor, in values of a picture's outputs; -1: none
  std::size_t output_count_ = 0;                 // values of a picture's outputs
  Buffer constants_, memory_, input_, outputs_;  // on the device
  Buffer input_up_, outputs_down_;
  Matmul16 matmul_;
  Depthwise16 depthwise_;
  ConvFirst16 conv_first_;
  Add16 add_;
  Resize2x16 resize_;
  Maxpool2x16 maxpool_;
  DepthToSpace16 depth_to_space_;
  SumPixels16 sum_pixels_;
  std::unique_ptr<Recorder> recorder_;  // last: it waits for its work
};

}  // namespace duo::vk
