// Folders of pictures as people name them.
#include <gtest/gtest.h>

#include <map>

#include "duoptic/calibrate.h"
#include "tests/write_media.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

class NamesOfPairs : public ::testing::Test {
 protected:
  /// Pictures of one brightness each, by which they are known again.
  void put(const std::string& folder, const std::vector<std::string>& names) {
    fs::create_directories(folder_ / folder);
    for (const std::string& name : names) {
      const auto level = static_cast<char>(++last_);
      test::put(folder_ / (folder + "/" + name), "P5\n4 2\n255\n" + std::string(8, level));
      level_[folder + "/" + name] = last_;
    }
  }
  /// "left right" of each pair, as names in their folders.
  std::vector<std::string> pairs(const std::string& left, const std::string& right) {
    std::vector<std::string> out;
    auto pictures = BoardPictures::open(folder_ / left, right.empty() ? fs::path() : folder_ / right);
    if (!pictures) return {pictures.error().what};
    Pair pair;
    std::string name;
    while (true) {
      const auto more = pictures->next(pair, name);
      if (!more) return {more.error().what};
      if (!*more) return out;
      out.push_back(name);
      const std::string second = right.empty() ? left : right;
      EXPECT_EQ(pair.left.pixels.at(0, 0).g, level_[left + "/" + name.substr(0, name.find(' '))]);
      EXPECT_EQ(pair.right.pixels.at(0, 0).g, level_[second + "/" + name.substr(name.find(' ') + 1)]);
    }
  }

  test::TempFolder folder_;
  std::map<std::string, int> level_;
  int last_ = 0;
};

using Names = std::vector<std::string>;

TEST_F(NamesOfPairs, SidesInAnyCaseAndNothingHidden) {
  put("a", {"Left01.pgm", "Right01.pgm", "Left02.pgm", "Right02.pgm", "._Left01.pgm", "._Right01.pgm"});
  EXPECT_EQ(pairs("a", ""), (Names{"Left01.pgm Right01.pgm", "Left02.pgm Right02.pgm"}));
  put("b", {"shot_7_LEFT.pgm", "shot_7_right.pgm", "shot_12_LEFT.pgm", "shot_12_right.pgm"});
  EXPECT_EQ(pairs("b", "").size(), 2u);
}

TEST_F(NamesOfPairs, TheLastNumberOrWhatDiffers) {
  put("cam0", {"cam0_0001.pgm", "cam0_0002.pgm", "cam0_0010.pgm"});
  put("cam1", {"cam1_2.pgm", "cam1_10.pgm", "cam1_1.pgm", "cam1_77.pgm"});
  EXPECT_EQ(pairs("cam0", "cam1"),
            (Names{"cam0_0001.pgm cam1_1.pgm", "cam0_0010.pgm cam1_10.pgm", "cam0_0002.pgm cam1_2.pgm"}));
  // The last number is the same in all: the one before it tells.
  put("l", {"img_8_640x480.pgm", "img_9_640x480.pgm", "img_10_640x480.pgm"});
  put("r", {"pic_09_1280x960.pgm", "pic_10_1280x960.pgm", "pic_08_1280x960.pgm"});
  EXPECT_EQ(pairs("l", "r").size(), 3u);
  EXPECT_EQ(pairs("l", "r")[0], "img_10_640x480.pgm pic_10_1280x960.pgm");
  // No numbers at all.
  put("x", {"near.pgm", "far.pgm"});
  put("y", {"near.pgm", "far.pgm", "tilted.pgm"});
  EXPECT_EQ(pairs("x", "y"), (Names{"far.pgm far.pgm", "near.pgm near.pgm"}));
  put("same", {"a_1_2.pgm", "b_1_2.pgm"});
  EXPECT_EQ(pairs("same", "y").size(), 1u);
}

TEST_F(NamesOfPairs, PhotosThatHoldBothViews) {
  fs::create_directories(folder_ / "both");
  for (const char* name : {"p1.pgm", "p2.pgm"}) test::put(folder_ / (std::string("both/") + name), "P5\n4 2\n255\nABCDABCD");
  auto pictures = BoardPictures::open(folder_ / "both", {});
  ASSERT_TRUE(pictures) << pictures.error().what;
  EXPECT_EQ(pictures->count(), 2);
  Pair pair;
  std::string name;
  const auto more = pictures->next(pair, name);
  ASSERT_TRUE(more && *more);
  EXPECT_EQ(name, "p1.pgm");
  EXPECT_EQ(pair.left.pixels.at(0, 0).g, 'A');
  EXPECT_EQ(pair.right.pixels.at(0, 0).g, 'C');
}

}  // namespace
}  // namespace duo
