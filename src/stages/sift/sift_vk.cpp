#include "stages/sift/sift_vk.h"

#include <algorithm>

#include "stages/sift/kernels.h"
#include "stages/sift/sift_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kSiftBlurCode[] = {
#include "spirv/sift.comp.inc"
};
constexpr std::uint32_t kSiftMarkCode[] = {
#include "spirv/sift_mark.comp.inc"
};
constexpr std::uint32_t kSiftListsCode[] = {
#include "spirv/sift_lists.comp.inc"
};
constexpr std::uint32_t kSiftRefineCode[] = {
#include "spirv/sift_refine.comp.inc"
};
constexpr std::uint32_t kSiftOrientCode[] = {
#include "spirv/sift_orient.comp.inc"
};
constexpr std::uint32_t kSiftDescribeCode[] = {
#include "spirv/sift_describe.comp.inc"
};
static_assert(kSiftLevels == SiftScratch::kLevels && kSiftMostAngles == SiftScratch::kMostAngles);
static_assert(kSiftBorder == sift::kBorder && kSiftSmallest == sift::kSmallestOctave && kSiftFixed == sift::kFixed);
static_assert(sizeof(Window) == 16);  // kernels read windows as they are

constexpr int kCandidatesPerPoint = 4;

int groups_of(int items, int group) { return (items + group - 1) / group; }

std::size_t words(int a, int b) { return static_cast<std::size_t>(a) * static_cast<std::size_t>(b) * 4; }

SiftShape shape_of(Size picture, Size room, const SiftListShape& lists, const SiftParams& params) {
  return {picture.width, picture.height, room.width,
          room.height,   params.octaves, params.margin_px,
          lists.lists,   lists.capacity, kCandidatesPerPoint * lists.capacity};
}

}  // namespace

Result<Sift::Scratch> Sift::Scratch::make(const Device& device, Size largest_window, int windows, int capacity,
                                          const SiftParams& params) {
  DUO_CHECK(windows > 0 && capacity > 0 && kCandidatesPerPoint * capacity <= kSiftMostCandidates);
  DUO_CHECK(params.octaves >= 1 && params.octaves <= 8 && params.margin_px >= 0);
  Scratch out;
  const int more = 2 * params.margin_px + (1 << (params.octaves - 1));  // the grid of the last octave moves the corner
  out.room_ = {largest_window.width + more, largest_window.height + more};
  out.windows_ = windows;
  out.capacity_ = capacity;
  out.params_ = params;
  const SiftShape shape = shape_of({}, out.room_, out.list_shape(), params);
  const int pixels = sift_pixels_before(shape, params.octaves);
  DUO_TRY_ASSIGN(out.planes_, Buffer::make(device, "sift planes", words(windows, kSiftPlanes * pixels), Memory::kDevice));
  DUO_TRY_ASSIGN(out.claims_, Buffer::make(device, "sift claims", words(windows, kSiftLevels * pixels), Memory::kDevice));
  DUO_TRY_ASSIGN(out.work_, Buffer::make(device, "sift lists", words(windows, sift_work(shape).words), Memory::kDevice));
  DUO_TRY_ASSIGN(out.groups_, Buffer::make(device, "sift groups", words(kSiftGroupWords, 1), Memory::kDevice));
  return out;
}

Result<Sift> Sift::make(const Device& device) {
  Sift out;
  const auto kernel = [&](const char* name, std::span<const std::uint32_t> code, int buffers) {
    return Kernel::make(device, {name, code, buffers, sizeof(SiftPointPush)});
  };
  DUO_TRY_ASSIGN(out.blur_, Kernel::make(device, {"sift blur", kSiftBlurCode, 3, sizeof(SiftBlurPush)}));
  DUO_TRY_ASSIGN(out.mark_, kernel("sift mark", kSiftMarkCode, 5));
  DUO_TRY_ASSIGN(out.lists_, kernel("sift lists", kSiftListsCode, 4));
  DUO_TRY_ASSIGN(out.refine_, kernel("sift refine", kSiftRefineCode, 4));
  DUO_TRY_ASSIGN(out.orient_, kernel("sift orient", kSiftOrientCode, 3));
  DUO_TRY_ASSIGN(out.describe_, kernel("sift describe", kSiftDescribeCode, 4));
  return out;
}

void Sift::record(Recorder& recorder, BufferView<std::uint8_t> src, const Buffer& windows, const Scratch& scratch,
                  const Buffer& points, Size size) const {
  const SiftListShape lists = scratch.list_shape();
  DUO_CHECK(src.holds(size) && windows.bytes() >= static_cast<std::size_t>(lists.lists) * sizeof(Window));
  DUO_CHECK(points.bytes() >= sift_list_bytes(lists));
  const SiftParams& params = scratch.params_;
  const SiftShape shape = shape_of(size, scratch.room_, lists, params);

  const auto blur = [&](int octave, int level) {
    const sift::BlurKernel kernel = level == 0 ? sift::blur_of_picture() : sift::blur_to(level);
    DUO_CHECK(kernel.radius <= kSiftMostBlur);
    SiftBlurPush push{shape, src.plane, octave, level, kernel.radius, {}};
    std::copy_n(kernel.weight, kernel.radius + 1, push.weight);
    const Size room{groups_of(shape.room_width, 1 << octave), groups_of(shape.room_height, 1 << octave)};
    const int tiles = groups_of(room.width, kSiftTileWidth) * groups_of(room.height, kSiftTileHeight);
    recorder.dispatch(blur_, push, {reads(windows), reads(src), writes(scratch.planes_)}, {tiles, lists.lists});
  };
  blur(0, 0);
  for (int octave = 0; octave < params.octaves; ++octave)
    for (int level = 1; level < kSiftBlurred; ++level) blur(octave, level);

  SiftPointPush push{shape, sift::least_difference(params), params.contrast, params.edge, 0};
  const Use planes = reads(scratch.planes_), work = writes(scratch.work_), claims = writes(scratch.claims_);
  const auto list = [&](int step) {
    push.step = step;
    recorder.dispatch(lists_, push, {reads(scratch.claims_), work, writes(scratch.groups_), writes(points)}, {1, lists.lists});
  };
  const auto for_each = [&](const Kernel& kernel, std::initializer_list<Use> uses, int groups) {
    recorder.dispatch_indirect(kernel, push, uses, scratch.groups_, static_cast<std::size_t>(groups) * 4);
  };
  const int positions = kSiftLevels * sift_pixels_before(shape, params.octaves);
  recorder.dispatch(mark_, push, {reads(windows), planes, claims, work, writes(scratch.groups_)},
                    {groups_of(positions, kSiftLanes), lists.lists});
  list(kSiftCandidates);
  for_each(refine_, {reads(windows), planes, claims, work}, kSiftRefineGroups);
  list(kSiftPlaces);
  for_each(orient_, {reads(windows), planes, work}, kSiftOrientGroups);
  list(kSiftPoints);
  for_each(describe_, {reads(windows), planes, reads(scratch.work_), writes(points)}, kSiftDescribeGroups);
}

}  // namespace duo::vk
