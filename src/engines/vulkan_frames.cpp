#include "engines/vulkan_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/check.h"
#include "core/clock.h"
#include "stages/depth/depth.h"
#include "stages/fill/fill.h"
#include "vulkan/maps.h"

namespace duo::vk {
namespace {

constexpr int kMostParts = 96;  // stages of all levels of a pyramid

template <class T>
Result<Buffer> sent(Device& device, const char* name, const Image<T>& image) {
  std::vector<T> packed;
  for (int y = 0; y < image.height(); ++y) packed.insert(packed.end(), image.row(y), image.row(y) + image.width());
  return make_filled(device, name, std::as_bytes(std::span(packed)));
}

/// Where the raw picture covers the rectified one: the same in every frame.
Image<std::uint8_t> inside_of(const ResampleMap& map, Size raw) {
  Image<std::uint8_t> rectified(map.corner.size()), inside(map.corner.size());
  ref::rectify(Image<std::uint8_t>(raw), map, rectified, inside);
  return inside;
}

}  // namespace

Result<std::unique_ptr<Frames>> Frames::make(const std::shared_ptr<Device>& device, const Prepared& prepared) {
  std::unique_ptr<Frames> out(new Frames(*device, prepared));
  DUO_TRY(out->make_kernels());
  if (prepared.setup.wants.on_device && out->rectifies() && !prepared.setup.fill) {
    out->on_device_ = std::make_shared<FrameMaps>();
    out->on_device_->device = device;
    out->on_device_->size = prepared.size;
    out->on_device_->time_stages = prepared.setup.time_stages;
    out->on_device_->slots.resize(kSlots);
  }
  DUO_TRY(out->make_maps());
  out->slots_.resize(static_cast<std::size_t>(out->on_device_ ? kSlots : kInFlight));
  for (Slot& slot : out->slots_) {
    DUO_TRY(out->make_slot(slot));
    DUO_TRY(out->record(slot));
  }
  device->keep_pipelines();
  return out;
}

Result<void> Frames::make_kernels() {
  if (prepared_.diffusion) return Error{ErrorCode::kUnsupported, "set up denoising on a device: diffusion has no kernel"};
  DUO_TRY_ASSIGN(gray_, Gray::make(device_));
  if (prepared_.median) {
    DUO_TRY_ASSIGN(median_, Median::make(device_));
  }
  if (prepared_.gaussian) {
    DUO_TRY_ASSIGN(gaussian_, Gaussian::make(device_));
  }
  if (rectifies()) {
    DUO_TRY_ASSIGN(rectify_, Rectify::make(device_));
  }
  const auto make_matcher = [&]<class M>(const Chosen<M>& chosen) -> Result<void> {
    DUO_TRY_ASSIGN(matcher_, M::Vulkan::make(device_, chosen.params, match_setup(prepared_)));
    return {};
  };
  DUO_TRY(std::visit(make_matcher, prepared_.matcher));
  DUO_TRY_ASSIGN(fill_, Fill::make(device_));
  if (prepared_.setup.wants.depth && !prepared_.setup.fill) {
    DUO_TRY_ASSIGN(depth_, Depth::make(device_, focal_baseline_px_mm(*prepared_.geometry)));
  }
  return {};
}

Result<void> Frames::make_maps() {
  const auto* maps = rectifies() ? &*prepared_.rectification : nullptr;
  DUO_TRY(make_view(views_[0], "left", maps != nullptr ? &maps->left : nullptr));
  DUO_TRY(make_view(views_[1], "right", maps != nullptr ? &maps->right : nullptr));
  const Size size = prepared_.size;
  const Wants& wants = prepared_.setup.wants;
  const auto make = [&](FrameMaps::Slot& maps, bool color) -> Result<void> {
    if (rectifies()) DUO_TRY(make_map<std::uint8_t>(device_, "rectified left", size, maps.left));
    DUO_TRY(make_map<std::uint16_t>(device_, "disparity", size, maps.d_q4));
    if (color) DUO_TRY(make_map<Rgb8>(device_, "color", size, maps.color));
    return {};
  };
  if (on_device_)
    for (FrameMaps::Slot& slot : on_device_->slots) DUO_TRY(make(slot, true));
  else
    DUO_TRY(make(maps_, prepared_.color && rectifies()));
  if (rectifies()) DUO_TRY(make_map<std::uint8_t>(device_, "rectified right", size, right_));
  DUO_TRY(make_map<std::uint8_t>(device_, "origin", size, origin_));
  if (prepared_.setup.fill) filling_.emplace(size, prepared_.setup.max_disparity);
  if (wants.confidence) DUO_TRY(make_map<std::uint8_t>(device_, "confidence", size, confidence_));
  if (wants.depth) DUO_TRY(make_map<std::uint16_t>(device_, "depth", size, depth_mm_));
  return {};
}

Result<void> Frames::make_view(ViewMaps& view, const char* name, const ResampleMap* map) {
  const Size raw = prepared_.setup.size;
  DUO_TRY(make_map<Rgb8>(device_, name, raw, view.raw));
  DUO_TRY(make_map<std::uint8_t>(device_, name, raw, view.gray));
  DUO_TRY(make_map<std::uint8_t>(device_, name, raw, view.denoised));
  if (map == nullptr) return {};
  view.columns = map->columns;
  DUO_TRY_ASSIGN(view.corner, sent(device_, name, map->corner));
  DUO_TRY_ASSIGN(view.fraction_q8, sent(device_, name, map->fraction_q8));
  DUO_TRY_ASSIGN(view.inside, sent(device_, name, inside_of(*map, raw)));
  return {};
}

Result<void> Frames::make_slot(Slot& slot) {
  const Size size = prepared_.size;
  const Wants& wants = prepared_.setup.wants;
  const bool fill = prepared_.setup.fill;
  DUO_TRY_ASSIGN(Recorder recorder, Recorder::make(device_));
  slot.recorder.emplace(std::move(recorder));
  DUO_TRY_ASSIGN(slot.timer, Timer::make(device_, kMostParts));
  for (Buffer& raw : slot.raw) DUO_TRY(make_map<Rgb8>(device_, "pictures up", prepared_.setup.size, raw, Memory::kUpload));
  DUO_TRY_ASSIGN(slot.coding_noise_q4, Buffer::make(device_, "coding noise up", sizeof(std::int32_t), Memory::kUpload));
  const auto make = [&]<class T>(T, bool wanted, const char* name, Buffer& out) -> Result<void> {
    return wanted ? make_map<T>(device_, name, size, out, Memory::kDownload) : Result<void>{};
  };
  DUO_TRY(make(std::uint8_t{}, wants.views || fill, "left down", slot.down.left));
  DUO_TRY(make(std::uint8_t{}, wants.views, "right down", slot.down.right));
  DUO_TRY(make(std::uint16_t{}, wants.disparity || fill, "disparity down", slot.down.d_q4));
  DUO_TRY(make(std::uint8_t{}, wants.disparity && !fill, "origin down", slot.down.origin));
  DUO_TRY(make(std::uint8_t{}, wants.confidence, "confidence down", slot.down.confidence));
  DUO_TRY(make(std::uint16_t{}, wants.depth && !fill, "depth down", slot.down.depth_mm));
  return make(Rgb8{}, sends_color(), "color down", slot.down.color);
}

Result<void> Frames::record(Slot& slot) {
  slot.recorder->begin(prepared_.setup.time_stages ? &slot.timer : nullptr);
  const auto [left, right] = record_views(slot);
  record_depth(slot, left, right);
  record_downloads(slot, left, right);
  slot.recorder->stage("download");
  return slot.recorder->end();
}

/// Both views stage by stage, so that they run side by side. Denoising comes before resampling: only there is noise independent
/// from pixel to pixel.
std::array<BufferView<std::uint8_t>, 2> Frames::record_views(Slot& slot) {
  Recorder& recorder = *slot.recorder;
  const Size raw = prepared_.setup.size;
  const auto each = [&](const char* stage, auto&& f) {
    for (std::size_t i = 0; i < views_.size(); ++i) f(i);
    recorder.stage(stage);
  };
  std::array<BufferView<std::uint8_t>, 2> now, next;
  each("upload", [&](std::size_t i) { recorder.copy(slot.raw[i], views_[i].raw, slot.raw[i].bytes()); });
  each("gray", [&](std::size_t i) {
    now[i] = whole<std::uint8_t>(views_[i].gray, raw);
    next[i] = whole<std::uint8_t>(views_[i].denoised, raw);
    gray_.record(recorder, whole<Rgb8>(views_[i].raw, raw), now[i], raw);
  });
  if (prepared_.median)
    each("median", [&](std::size_t i) {
      median_.record(recorder, now[i], next[i], raw);
      std::swap(now[i], next[i]);
    });
  if (prepared_.gaussian)
    each("gaussian", [&](std::size_t i) {
      gaussian_.record(recorder, now[i], next[i], raw);
      std::swap(now[i], next[i]);
    });
  if (rectifies())
    each("rectify", [&](std::size_t i) {
      const auto out = whole<std::uint8_t>(i == 0 ? maps_of(slot).left : right_, prepared_.size);
      rectify_.record(recorder, now[i], map_of(views_[i]), out, {}, prepared_.size);
      now[i] = out;
    });
  return now;
}

void Frames::record_match(Slot& slot, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right,
                          BufferView<std::uint16_t> d_q4) const {
  BufferView<std::uint8_t> left_inside, right_inside, confidence;
  if (rectifies()) {
    left_inside = whole<std::uint8_t>(views_[0].inside, prepared_.size);
    right_inside = whole<std::uint8_t>(views_[1].inside, prepared_.size);
  }
  if (prepared_.setup.wants.confidence) confidence = whole<std::uint8_t>(confidence_, prepared_.size);
  const MatchInput pair{left, right, left_inside, right_inside, &slot.coding_noise_q4};
  std::visit([&](const auto& matcher) { matcher.record(*slot.recorder, pair, {d_q4, confidence}); }, *matcher_);
}

void Frames::record_depth(Slot& slot, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right) {
  Recorder& recorder = *slot.recorder;
  const Size size = prepared_.size;
  const auto d_q4 = whole<std::uint16_t>(maps_of(slot).d_q4, size);
  record_match(slot, left, right, d_q4);
  fill_.record_measured(recorder, d_q4, whole<std::uint8_t>(origin_, size), size);
  recorder.stage("fill");
  if (depth_) {
    depth_->record(recorder, d_q4, whole<std::uint16_t>(depth_mm_, size), size);
    recorder.stage("depth");
  }
}

void Frames::record_downloads(Slot& slot, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right) {
  Recorder& recorder = *slot.recorder;
  const FrameMaps::Slot& maps = maps_of(slot);
  if (prepared_.color && rectifies()) {
    if (views_[0].columns == ResampleMap::Columns::kSoft)
      recorder.copy(views_[0].raw, maps.color, maps.color.bytes());
    else
      rectify_.record(recorder, whole<Rgb8>(views_[0].raw, prepared_.setup.size), map_of(views_[0]),
                      whole<Rgb8>(maps.color, prepared_.size), prepared_.size);
    recorder.stage("color");
  }
  const auto down = [&](const Buffer& from, const Buffer& to) {
    if (to.bytes() > 0) recorder.copy(from, to, std::min(from.bytes(), to.bytes()));
  };
  down(*left.buffer, slot.down.left);
  down(*right.buffer, slot.down.right);
  down(maps.d_q4, slot.down.d_q4);
  down(origin_, slot.down.origin);
  down(confidence_, slot.down.confidence);
  down(depth_mm_, slot.down.depth_mm);
  down(rectifies() ? maps.color : views_[0].raw, slot.down.color);
}

const FrameMaps::Slot& Frames::maps_of(const Slot& slot) const {
  return on_device_ ? on_device_->slots[static_cast<std::size_t>(&slot - slots_.data())] : maps_;
}

Rectify::Map Frames::map_of(const ViewMaps& view) const {
  return {whole<std::uint32_t>(view.corner, prepared_.size), whole<std::uint16_t>(view.fraction_q8, prepared_.size),
          view.columns, prepared_.setup.size.height};
}

Result<void> Frames::submit(int slot, const Pair& pair) {
  Slot& at = slots_[static_cast<std::size_t>(slot)];
  pack(pair.left.pixels, at.raw[0]);
  pack(pair.right.pixels, at.raw[1]);
  const std::int32_t noise_q4 = coding_noise_q4(prepared_, pair);
  std::memcpy(at.coding_noise_q4.mapped().data(), &noise_q4, sizeof noise_q4);
  DUO_TRY_ASSIGN(at.ticket, at.recorder->submit());
  return {};
}

Result<void> Frames::collect(int slot, Frame& frame) {
  Slot& at = slots_[static_cast<std::size_t>(slot)];
  DUO_TRY(device_.wait(at.ticket, device_.patience_ns()));
  unpack(at.down.left, frame.left);
  unpack(at.down.right, frame.right);
  unpack(at.down.d_q4, frame.disparity.d_q4);
  unpack(at.down.origin, frame.disparity.origin);
  unpack(at.down.confidence, frame.confidence);
  unpack(at.down.depth_mm, frame.depth_mm);
  unpack(at.down.color, frame.color);
  frame.stages = {};
  if (prepared_.setup.time_stages) {
    DUO_TRY_ASSIGN(const auto times, at.timer.read());
    for (const Timer::Time& t : times) add_time(frame.stages, t.stage, static_cast<std::int64_t>(t.ns), 0);
  }
  if (filling_) fill(frame);
  return {};
}

/// And depth, which follows from what was filled.
void Frames::fill(Frame& frame) {
  const std::int64_t wall_before = wall_ns(), cpu_before = cpu_ns();
  simd::mark_measured(pool_, frame.disparity.d_q4, frame.disparity.origin);
  filling_->fill(pool_, frame.left, frame.disparity);
  if (prepared_.setup.wants.depth)
    simd::depth(pool_, frame.disparity.d_q4, focal_baseline_px_mm(*prepared_.geometry), frame.depth_mm);
  if (prepared_.setup.time_stages) add_time(frame.stages, "fill", wall_ns() - wall_before, cpu_ns() - cpu_before);
}

Frame Frames::make_frame() const {
  Frame frame = duo::make_frame(prepared_);
  const Wants& wants = prepared_.setup.wants;
  const bool fill = prepared_.setup.fill;  // what filling looks at stays
  if (!wants.views) frame.right = {}, frame.left_inside = {}, frame.right_inside = {};
  if (!wants.views && !fill) frame.left = {};
  if (!wants.disparity && !fill) frame.disparity = {};
  if (!sends_color()) frame.color = {};
  if (wants.views && rectifies()) {
    frame.left_inside = inside_of(prepared_.rectification->left, prepared_.setup.size);
    frame.right_inside = inside_of(prepared_.rectification->right, prepared_.setup.size);
  }
  return frame;
}

}  // namespace duo::vk
