#include <cmath>
#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "duoptic/reports.h"

namespace duo {
namespace {

/// Hundredths: what lies below is noise of the picture.
double rounded(double value, double steps) { return std::round(value * steps) / steps; }

nlohmann::ordered_json people_json(const SeenHand& hand) {
  nlohmann::ordered_json points;
  for (std::size_t i = 0; i < kHandPoints; ++i)
    points[std::string(hand_point_name(i))] = {rounded(hand.points[i].x_px(), 100), rounded(hand.points[i].y_px(), 100)};
  return {{"score", rounded(hand.score_q15 / 32768.0, 1e4)}, {"points", points}};
}

nlohmann::ordered_json people_json(const SeenPerson& person) {
  nlohmann::ordered_json points;
  for (std::size_t i = 0; i < kBodyPoints; ++i) {
    const SeenPoint& point = person.body.points[i];
    points[std::string(name_of(static_cast<BodyPoint>(i)))] = {rounded(point.x_px(), 100), rounded(point.y_px(), 100),
                                                               rounded(point.visibility(), 1e4)};
  }
  const Window& box = person.box_px;
  nlohmann::ordered_json out = {{"box_px", {box.x, box.y, box.width, box.height}},
                                {"score", rounded(person.body.score_q15 / 32768.0, 1e4)},
                                {"points", points}};
  if (person.left_hand) out["hands"]["left"] = people_json(*person.left_hand);
  if (person.right_hand) out["hands"]["right"] = people_json(*person.right_hand);
  return out;
}

}  // namespace

std::string json_of(std::span<const SeenPerson> people) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const SeenPerson& person : people) all.push_back(people_json(person));
  return json_text(nlohmann::ordered_json{{"people", all}}, -1);
}

}  // namespace duo
