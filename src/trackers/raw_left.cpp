#include "trackers/raw_left.h"

#include <fmt/format.h>

#include <algorithm>

namespace duo::arm {
namespace {

Error refused(std::string what) { return {ErrorCode::kBadInput, std::move(what)}; }

}  // namespace

Result<RawLeft> RawLeft::of(const TrackerSetup& setup) {
  const Rectified& r = setup.rectified;
  if (r.size.width < 64 || r.size.height < 64 || !(r.focal_px > 0) || !(r.baseline_m > 0))
    return refused(
        fmt::format("prepare the arm tracker: rectified pictures of {}x{} are too small or without geometry; give it what "
                    "the engine's rectified() returns",
                    r.size.width, r.size.height));
  if (!(setup.frame_s > 0 && setup.frame_s < 1))
    return refused(fmt::format("prepare the arm tracker: {} s from frame to frame is not between 0 and 1", setup.frame_s));
  return RawLeft(setup.rig.left, r);
}

Result<std::array<Vec2, kParts>> RawLeft::rectified(const Selection& selection) const {
  if (std::find(kArms.begin(), kArms.end(), selection.skeleton) == kArms.end())
    return refused("select the arm: the selection has another skeleton than right_arm or left_arm");
  std::array<Vec2, kParts> out;
  const Size size = lens_.camera().size;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const JointDef& joint = selection.skeleton->joints[i];
    const auto given = std::find_if(selection.clicks.begin(), selection.clicks.end(),
                                    [&](const Click& click) { return click.joint == joint.id; });
    if (given == selection.clicks.end())
      return refused(fmt::format("select the arm: no click on the {}; give one on each joint", joint.name));
    const Vec2 click = {given->x_px, given->y_px};
    const auto bad = [&](const char* why) {
      return refused(fmt::format("select the arm: the {} click ({:g}, {:g}) {} of {}x{}; click on the raw left picture",
                                 joint.name, click.x, click.y, why, size.width, size.height));
    };
    if (!lens_.covers(click, 0.5)) return bad("lies outside the picture");
    const auto ray = lens_.ray_of(click);
    const Vec3 turned = ray ? geometry_.rig_from_left * *ray : Vec3{};
    if (!(turned.z > 0)) return bad("is seen by no ray of the lens, in the picture");
    out[i] = geometry_.project(turned);
    if (!(out[i].x >= 0 && out[i].y >= 0 && out[i].x <= geometry_.size.width - 1 && out[i].y <= geometry_.size.height - 1))
      return bad("is not seen by both cameras, in the picture");
  }
  return out;
}

void RawLeft::set_pixel(Joint& joint) const {
  const auto pixel = lens_.pixel_of(transposed(geometry_.rig_from_left) * joint.p_in_rig_m);
  if (!pixel) return;
  joint.u_px = pixel->x;
  joint.v_px = pixel->y;
}

Result<void> RawLeft::check(const Frame& frame, std::size_t arms) const {
  if (arms < 1 || arms > kMostArms)
    return refused(fmt::format("select the arm: {} arms were given; this tracker follows 1 or 2", arms));
  if (frame.color.size() != geometry_.size || frame.left.size() != geometry_.size)
    return refused(
        "select the arm: the frame lacks the colour picture or has another size than prepared; prepare the engine with what "
        "the tracker wants");
  return {};
}

std::vector<Person> persons_of(std::span<const Selection> selections) {
  std::vector<Person> out;
  for (const Selection& selection : selections) {
    Person& person = out.emplace_back();
    person.id = static_cast<std::uint32_t>(out.size());
    person.skeleton = selection.skeleton;
  }
  return out;
}

}  // namespace duo::arm
