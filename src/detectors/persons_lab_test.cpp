// Photographs of people in a laboratory, one to five at once, up to 7.9 m away: which torsos are found, and whether others are.
#include <cmath>

#include "duoptic/detector.h"
#include "duoptic/source.h"
#include "tests/agree.h"
#include "tests/data.h"

namespace duo {
namespace {

struct Torso {
  int x_px, y_px;  // its centre
};
/// Labelled by eye, to about 30 px. The later ones may be missed: they stand behind others or leave the picture.
struct Photograph {
  const char* name;
  std::vector<Torso> torsos, hard = {};
};
const Photograph kPhotographs[] = {
    {"dist_cm_150_350/151448", {{990, 480}, {1460, 440}}},
    {"dist_cm_150_350/151454", {{980, 480}, {1460, 440}}},
    {"dist_cm_160/152826", {{1060, 430}}},
    {"dist_cm_160/152828", {{1060, 440}}},
    {"dist_cm_160/152834", {{1070, 440}}},
    {"dist_cm_176/152903", {{1070, 440}}},
    {"dist_cm_176_504/152544", {{1170, 490}, {730, 460}}},
    {"dist_cm_176_504/152545", {{1170, 490}, {730, 460}}},
    {"dist_cm_204_722/152356", {{1160, 510}, {800, 450}}},
    {"dist_cm_204_722/152357", {{1160, 510}, {810, 460}}},
    {"dist_cm_240/152742", {{1080, 470}}},
    {"dist_cm_240/152744", {{1070, 470}}},
    {"dist_cm_250_350/151856", {{980, 480}, {1340, 470}}},
    {"dist_cm_250_350/151901", {{980, 480}, {1340, 470}}},
    {"dist_cm_298_604/152221", {{970, 470}, {1130, 500}}},
    {"dist_cm_298_604/152223", {{970, 470}, {1130, 500}}},
    {"dist_cm_790/153041", {{1010, 570}}},
    {"dist_cm_790/153042", {{1010, 570}}},
    {"dist_cm_790/153044", {{1000, 570}}},
    {"group/153459", {{1530, 430}, {880, 460}, {270, 430}}},
    {"group/153501", {{880, 470}, {240, 430}, {1500, 440}}},
    {"group/153502", {{880, 460}, {1470, 410}, {250, 430}}},
    {"group/153503", {{1460, 440}, {880, 460}, {260, 420}}},
    {"group/153504", {{1450, 430}, {870, 460}, {280, 420}}},
    {"group/153505", {{1460, 440}, {870, 450}, {280, 430}}},
    {"group/153506", {{1450, 440}, {880, 450}, {280, 430}}},
    {"group/153507", {{880, 460}, {1450, 450}, {280, 430}}},
    {"group/153508", {{880, 460}, {1460, 450}, {270, 430}}},
    {"group/153509", {{290, 410}, {880, 460}, {1460, 440}}},
    {"group/153519", {{1520, 450}, {1030, 440}, {290, 430}, {650, 440}}},
    {"group/153521", {{1140, 460}, {760, 440}, {1550, 450}, {430, 420}}},
    {"group/153522", {{1130, 460}, {760, 450}, {1580, 460}, {410, 420}}},
    {"group/153524", {{1130, 470}, {1560, 460}, {750, 440}, {370, 420}}},
    {"group/153525", {{750, 440}, {1140, 460}, {1570, 460}, {350, 420}}, {{1390, 420}}},
    {"group/153527", {{750, 440}, {1140, 470}, {1540, 450}, {340, 430}}, {{1390, 420}}},
    {"group/153528", {{1140, 460}, {750, 450}, {1610, 450}, {400, 420}}, {{1390, 420}}},
    {"group/153531", {{1100, 470}, {1530, 490}, {750, 440}, {380, 450}}, {{1800, 460}}},
    {"group/153533", {{750, 440}, {1130, 480}, {1520, 480}, {330, 460}}, {{1800, 460}}},
    {"group/153535", {{740, 440}, {1120, 470}, {1520, 480}, {320, 460}}, {{1800, 460}}},
    {"group/153536", {{740, 450}, {1120, 480}, {1520, 480}, {320, 460}}, {{1800, 460}}},
    {"group/153537", {{740, 440}, {1120, 480}, {1520, 480}, {330, 460}}, {{1800, 460}}},
    {"group/153538", {{1120, 480}, {740, 440}, {1520, 480}, {200, 460}, {1820, 400}}},
};

bool near(const SeenPerson& person, const Torso& torso) {
  using enum BodyPoint;
  double x = 0, y = 0;
  for (const BodyPoint corner : {kLeftShoulder, kRightShoulder, kLeftHip, kRightHip}) {
    x += person.body.at(corner).x_px() / 4;
    y += person.body.at(corner).y_px() / 4;
  }
  return std::hypot(x - torso.x_px, y - torso.y_px) < 70;
}

TEST(PersonsLab, EveryTorsoIsFound) {
  const auto folder = test::data_folder() / "sequences/persons_lab_1080p";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no test data";
  const auto detector = make_detector({});
  ASSERT_TRUE(detector) << detector.error().what;
  PeopleFinder finder(**detector, {});
  int alone = 0, found_alone = 0, groups = 0, found_groups = 0, false_alone = 0, false_in_groups = 0;
  for (const Photograph& photograph : kPhotographs) {
    const auto source = open_source(folder / (std::string(photograph.name) + "_left.jpg"));
    ASSERT_TRUE(source) << source.error().what;
    Picture picture;
    ASSERT_TRUE((*source)->next(picture));
    const auto people = finder.look(picture.pixels);
    const auto seen = [&](const Torso& torso) {
      return std::ranges::any_of(people, [&](const auto& p) { return near(p, torso); });
    };
    int found = 0;
    for (const Torso& torso : photograph.torsos) {
      EXPECT_TRUE(seen(torso)) << photograph.name << " misses " << torso.x_px << "," << torso.y_px;
      found += seen(torso);
    }
    const bool group = std::string_view(photograph.name).starts_with("group");
    std::size_t of_no_one = 0;
    for (const SeenPerson& person : people) {
      const auto is_there = [&](const Torso& torso) { return near(person, torso); };
      if (std::ranges::any_of(photograph.torsos, is_there) || std::ranges::any_of(photograph.hard, is_there)) continue;
      std::printf("%s: no one is at %d,%d\n", photograph.name, person.box_px.x, person.box_px.y);
      ++(group ? false_in_groups : false_alone);
      ++of_no_one;
    }
    EXPECT_LE(people.size(), photograph.torsos.size() + photograph.hard.size() + of_no_one)
        << photograph.name << ": someone twice";
    (group ? groups : alone) += static_cast<int>(photograph.torsos.size());
    (group ? found_groups : found_alone) += found;
  }
  std::printf("one or two: %d of %d torsos; groups: %d of %d\n", found_alone, alone, found_groups, groups);
  EXPECT_EQ(alone, 29);
  EXPECT_EQ(false_alone, 0);
  EXPECT_LE(false_in_groups, 1) << "arms of two people that touch look like a third";
}

}  // namespace
}  // namespace duo
