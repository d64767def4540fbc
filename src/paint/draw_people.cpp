#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "duoptic/paint.h"

namespace duo {
namespace {

using enum BodyPoint;

struct DrawnBone {
  BodyPoint a, b;
};
constexpr DrawnBone kDrawnBones[] = {
    {kLeftShoulder, kRightShoulder}, {kLeftHip, kRightHip},      {kLeftShoulder, kLeftHip},   {kRightShoulder, kRightHip},
    {kLeftShoulder, kLeftElbow},     {kLeftElbow, kLeftWrist},   {kLeftWrist, kLeftIndex},    {kLeftWrist, kLeftPinky},
    {kRightShoulder, kRightElbow},   {kRightElbow, kRightWrist}, {kRightWrist, kRightIndex},  {kRightWrist, kRightPinky},
    {kLeftHip, kLeftKnee},           {kLeftKnee, kLeftAnkle},    {kLeftAnkle, kLeftHeel},     {kLeftAnkle, kLeftFootIndex},
    {kRightHip, kRightKnee},         {kRightKnee, kRightAnkle},  {kRightAnkle, kRightHeel},   {kRightAnkle, kRightFootIndex},
    {kLeftEar, kLeftEyeOuter},       {kLeftEyeOuter, kNose},     {kRightEar, kRightEyeOuter}, {kRightEyeOuter, kNose},
    {kMouthLeft, kMouthRight}};

const cv::Scalar kLeftColor(255, 140, 30), kRightColor(30, 170, 255), kMiddleColor(240, 240, 240);
const cv::Scalar kFingerColors[] = {{255, 80, 80}, {255, 210, 60}, {90, 230, 90}, {80, 200, 255}, {210, 120, 255}};

cv::Scalar color_of(std::string_view name) {
  return name.starts_with("left") || name.ends_with("left")     ? kLeftColor
         : name.starts_with("right") || name.ends_with("right") ? kRightColor
                                                                : kMiddleColor;
}

cv::Point place(const SeenPoint& point) {  // 4 bits below whole pixels
  return {(point.x_q8 + 8) >> 4, (point.y_q8 + 8) >> 4};
}

/// Where a point is probably hidden its colour is half the picture's gray.
cv::Scalar paled(const cv::Scalar& color, double visibility) {
  return visibility >= 0.5 ? color : 0.45 * color + 0.55 * cv::Scalar(110, 110, 110);
}

void draw_hand(cv::Mat& rgb, const SeenHand& hand, int thickness) {
  for (std::size_t i = 1; i < kHandPoints; ++i) {
    const std::size_t from = i % kJointsPerFinger == 1 ? 0 : i - 1;
    cv::line(rgb, place(hand.points[from]), place(hand.points[i]), kFingerColors[(i - 1) / kJointsPerFinger], thickness,
             cv::LINE_AA, 4);
  }
  for (const SeenPoint& point : hand.points)
    cv::circle(rgb, place(point), thickness * 16, cv::Scalar(20, 20, 20), cv::FILLED, cv::LINE_AA, 4);
}

}  // namespace

void draw_people(std::span<const SeenPerson> people, View<Rgb8> picture) {
  cv::Mat rgb(picture.height(), picture.width(), CV_8UC3, picture.data(),
              static_cast<std::size_t>(picture.stride()) * sizeof(Rgb8));
  for (const SeenPerson& person : people) {
    const int thickness = std::clamp(person.box_px.height / 150, 1, 4);
    const auto drawable = [&](const SeenPoint& point) {  // far outside, lines would wrap
      return std::abs(point.x_px()) < 1e4 && std::abs(point.y_px()) < 1e4;
    };
    for (const DrawnBone& bone : kDrawnBones) {
      const SeenPoint &a = person.body.at(bone.a), &b = person.body.at(bone.b);
      if (!drawable(a) || !drawable(b)) continue;
      const bool one_side = name_of(bone.a).substr(0, 4) == name_of(bone.b).substr(0, 4);
      const cv::Scalar color = one_side ? color_of(name_of(bone.a)) : kMiddleColor;
      cv::line(rgb, place(a), place(b), paled(color, std::min(a.visibility(), b.visibility())), thickness, cv::LINE_AA, 4);
    }
    for (std::size_t i = 0; i < kBodyPoints; ++i)
      if (drawable(person.body.points[i]))
        cv::circle(rgb, place(person.body.points[i]), (thickness + 1) * 16,
                   paled(color_of(name_of(static_cast<BodyPoint>(i))), person.body.points[i].visibility()), cv::FILLED,
                   cv::LINE_AA, 4);
    for (const auto* hand : {&person.left_hand, &person.right_hand})
      if (*hand) draw_hand(rgb, **hand, thickness);
    cv::rectangle(rgb, cv::Rect(person.box_px.x, person.box_px.y, person.box_px.width, person.box_px.height), kMiddleColor, 1);
  }
}

}  // namespace duo
