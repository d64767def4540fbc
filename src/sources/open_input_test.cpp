// The rig of an input is the one that is given, and has to be that of one view.
#include <gtest/gtest.h>

#include "duoptic/source.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using test::TempFolder;

// The left picture alone, where the rig is that of whole pictures.
TEST(OpenInput, HalfOfARigsPictureIsNoView) {
  const TempFolder folder;
  test::put(folder / "left.pgm", "P5\n8 2\n255\n" + std::string(16, 'a'));
  Rig rig;
  rig.left.size = rig.right.size = {8, 2};
  const std::string left = (folder / "left.pgm").string();
  const auto alone = open_input(left, "", rig);
  ASSERT_FALSE(alone);
  EXPECT_NE(alone.error().what.find("it has the 8x2 pixels that one view of the rig has"), std::string::npos)
      << alone.error().what;
  const auto both = open_input(left, left, rig);
  ASSERT_TRUE(both) << both.error().what;
  EXPECT_EQ(both->names, (std::vector<std::string>{left, left}));
  EXPECT_EQ(both->rig->left.size, (Size{8, 2}));
}

}  // namespace
}  // namespace duo
