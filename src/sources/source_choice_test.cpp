// Files that are given together, and what was looked at before.
#include "duoptic/source_choice.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/write_media.h"

namespace duo {
namespace {

TEST(SourceChoice, FilesInAnyOrder) {
  EXPECT_EQ(*choose_files({"b_right.avi", "rig.json", "a_left.avi"}), (SourceChoice{"a_left.avi", "b_right.avi", "rig.json"}));
  EXPECT_EQ(*choose_files({"a_right.avi", "b_left.avi"}), (SourceChoice{"b_left.avi", "a_right.avi", ""}));
  EXPECT_EQ(*choose_files({"cam1.mp4", "cam0.mp4"}), (SourceChoice{"cam0.mp4", "cam1.mp4", ""}));
  EXPECT_EQ(*choose_files({"clip.mkv"}), (SourceChoice{"clip.mkv", "", ""}));
  EXPECT_EQ(*choose_files({"camchain.yaml"}), (SourceChoice{"", "", "camchain.yaml"}));
  EXPECT_FALSE(choose_files({"a.avi", "b.avi", "c.avi"}));
  EXPECT_FALSE(choose_files({"a.json", "b.json"}));
}

TEST(SourceChoice, RecentOnesComeBackNewestFirst) {
  const test::TempFolder cache;
  ASSERT_EQ(setenv("XDG_CACHE_HOME", (cache / "").c_str(), 1), 0);
  EXPECT_TRUE(recent_sources().empty());
  for (int i = 0; i < 12; ++i) test::put(cache / ("clip" + std::to_string(i)), "x");
  for (int i = 0; i < 12; ++i) remember_source({(cache / ("clip" + std::to_string(i))).string(), "", ""});
  remember_source({"camera:0", "camera:2", (cache / "clip3").string()});
  remember_source({(cache / "clip9").string(), "", ""});
  const auto recent = recent_sources();
  ASSERT_EQ(recent.size(), kMostRecent);
  EXPECT_EQ(recent[0].left, (cache / "clip9").string());
  EXPECT_EQ(recent[1], (SourceChoice{"camera:0", "camera:2", (cache / "clip3").string()}));
  EXPECT_EQ(recent[2].left, (cache / "clip11").string());
  std::filesystem::remove(cache / "clip9");
  EXPECT_EQ(recent_sources()[0].left, "camera:0") << "its file is gone";
  remember_source({"a\nb", "", ""});
  EXPECT_EQ(recent_sources()[0].left, "camera:0");
  unsetenv("XDG_CACHE_HOME");
}

}  // namespace
}  // namespace duo
