#include "trackers/thesis/observe_joints_vk.h"

#include <algorithm>
#include <cstring>

#include "core/check.h"
#include "vulkan/area.h"

namespace duo::vk {
namespace {

constexpr SiftListShape kLists{kMaxTargets, JointPoints::kCapacity};
constexpr std::size_t kColorBytes = kMaxTargets * sizeof(AreaSums), kJointBytes = kMaxTargets * sizeof(ObservedJoint);

template <class T>
void put(const Buffer& to, std::size_t at, const T& record) {
  std::memcpy(to.mapped().data() + at * sizeof(T), &record, sizeof(T));
}

}  // namespace

Result<ObserveJoints> ObserveJoints::make(Device& device, Size size) {
  ObserveJoints out;
  out.size_ = size;
  DUO_TRY(out.make_kernels(device));
  DUO_TRY(out.make_memory(device));
  return out;
}

Result<void> ObserveJoints::make_kernels(Device& device) {
  DUO_TRY_ASSIGN(hsv_, Hsv::make(device));
  DUO_TRY_ASSIGN(mark_targets_, MarkTargets::make(device));
  DUO_TRY_ASSIGN(erode_, Erode::make(device));
  DUO_TRY_ASSIGN(region_, Region::make(device));
  DUO_TRY_ASSIGN(sums_, Sums::make(device));
  DUO_TRY_ASSIGN(sift_, Sift::make(device));
  DUO_TRY_ASSIGN(match_points_, MatchPoints::make(device));
  DUO_TRY_ASSIGN(place_joints_, PlaceJoints::make(device));
  return {};
}

Result<void> ObserveJoints::make_memory(Device& device) {
  const int side = std::max(joint_window_px(size_), 1);
  DUO_TRY_ASSIGN(forest_, Region::Scratch::make(device, {side, side}, kMaxTargets));
  DUO_TRY_ASSIGN(partial_, Sums::Scratch::make(device, kMaxTargets));
  DUO_TRY_ASSIGN(space_, Sift::Scratch::make(device, {side, side}, kMaxTargets, JointPoints::kCapacity));
  const auto pixels = static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height);
  constexpr std::size_t kPlaces = std::size_t{kMaxTargets} * JointPoints::kCapacity;
  struct {
    Buffer& buffer;
    const char* name;
    std::size_t bytes;
    Memory memory = Memory::kDevice;
  } const each[] = {
      {targets_, "targets", MarkTargets::target_bytes(), Memory::kUpload},
      {tasks_, "regions wanted", Region::task_bytes(kMaxTargets), Memory::kUpload},
      {areas_, "areas", kMaxTargets * sizeof(DeviceArea), Memory::kUpload},
      {windows_, "windows", kMaxTargets * sizeof(Window), Memory::kUpload},
      {places_, "expected places", kMaxTargets * sizeof(PlaceQ4), Memory::kUpload},
      {points_up_, "stored points up", sift_list_bytes(kLists), Memory::kUpload},
      {ways_up_, "ways to joints up", kPlaces * sizeof(PlaceQ4), Memory::kUpload},
      {points_, "stored points", sift_list_bytes(kLists)},
      {ways_, "ways to joints", kPlaces * sizeof(PlaceQ4)},
      {hue_, "hue", pixels},
      {saturation_, "saturation", pixels},
      {value_, "value", pixels},
      {marks_, "marks", pixels},
      {eroded_, "eroded marks", pixels},
      {labels_, "labels", kMaxTargets * sizeof(RegionLabel)},
      {colors_, "colour sums", kColorBytes},
      {seen_, "seen points", sift_list_bytes(kLists)},
      {matches_, "matches", kPlaces * sizeof(PointMatch)},
      {joints_, "joints", kJointBytes},
      {colors_down_, "colour sums down", kColorBytes, Memory::kDownload},
      {joints_down_, "joints down", kJointBytes, Memory::kDownload},
  };
  for (const auto& [buffer, name, bytes, memory] : each) {
    DUO_TRY_ASSIGN(buffer, Buffer::make(device, name, bytes, memory));
  }
  return {};
}

void ObserveJoints::record_points(Recorder& recorder) const {
  recorder.copy(points_up_, points_, points_.bytes());
  recorder.copy(ways_up_, ways_, ways_.bytes());
}

void ObserveJoints::record(Recorder& recorder, const Maps& maps) const {
  const auto whole = [&](const Buffer& buffer) { return BufferView<std::uint8_t>(buffer, {0, size_.width}); };
  const auto hue = whole(hue_), saturation = whole(saturation_), value = whole(value_);
  hsv_.record(recorder, maps.color, {hue, saturation, value}, size_);
  recorder.stage("hsv");
  mark_targets_.record(recorder, {hue, saturation, value, &targets_}, whole(marks_), size_);
  recorder.stage("mark_targets");
  erode_.record(recorder, whole(marks_), Neighbours::kFour, whole(eroded_), size_);
  recorder.stage("erode");
  region_.record(recorder, tasks_, kMaxTargets, whole(eroded_), forest_, labels_, size_);
  recorder.stage("region");
  sums_.record(recorder, {&areas_, kMaxTargets, whole(eroded_), hue, {}}, partial_, colors_, size_);
  recorder.stage("sums");
  sift_.record(recorder, maps.left, windows_, space_, seen_, size_);
  recorder.stage("sift");
  match_points_.record(recorder, {&points_, &seen_, nullptr, kLists, kLists}, {}, matches_);
  recorder.stage("match_points");
  place_joints_.record(recorder, {&places_, &colors_, &seen_, &matches_, &ways_, kLists, kLists, maps.d_q4}, joints_, size_);
  recorder.stage("place_joints");
  recorder.copy(colors_, colors_down_, kColorBytes);
  recorder.copy(joints_, joints_down_, kJointBytes);
  recorder.stage("download");
}

bool ObserveJoints::expect(const Expectation& expected) {
  DUO_CHECK(expected.count > 0 && expected.count <= kMaxTargets && expected.points != nullptr);
  DUO_CHECK(expected.points->size() == static_cast<std::size_t>(expected.count));
  std::array<Target, kMaxTargets> targets;
  std::array<duo::Region, kMaxTargets> regions;
  const auto count = static_cast<std::size_t>(expected.count);
  for (std::size_t i = 0; i < kMaxTargets; ++i) {
    const ExpectedJoint joint = i < count ? expected.joints[i] : ExpectedJoint{};  // no window, no pixel
    const Window& window = joint.target.window;
    DUO_CHECK(window.width <= joint_window_px(size_) && window.height <= joint_window_px(size_));
    const int bit = static_cast<int>(i);
    targets[i] = joint.target;
    regions[i] = {bit, window, joint.at.pixel()};
    put(areas_, i, device_area({window, {}, {}, static_cast<std::uint8_t>(1 << bit)}));
    put(windows_, i, window);
    put(places_, i, joint.at);
  }
  MarkTargets::write({targets.data(), count}, targets_.mapped());
  Region::write({regions.data(), count}, tasks_.mapped());
  if (expected.points == stored_) return false;
  stored_ = expected.points;
  std::memset(points_up_.mapped().data(), 0, points_up_.bytes());
  for (std::size_t i = 0; i < count; ++i) {
    const JointPoints& joint = (*stored_)[i];
    write_sift_list(joint.points, kLists, static_cast<int>(i), points_up_.mapped());
    std::memcpy(ways_up_.mapped().data() + i * JointPoints::kCapacity * sizeof(PlaceQ4), joint.to_joint.data(),
                joint.to_joint.size() * sizeof(PlaceQ4));
  }
  return true;
}

void ObserveJoints::read(Observation& seen) const {
  std::memcpy(seen.colors.data(), colors_down_.mapped().data(), kColorBytes);
  std::memcpy(seen.joints.data(), joints_down_.mapped().data(), kJointBytes);
}

}  // namespace duo::vk
