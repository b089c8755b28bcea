#include "raplas/output_file.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "raplas/image.hpp"
#include "test_folder.hpp"

namespace raplas {
namespace {

TEST(OutputFile, AppearsOnlyWithCommit) {
  const TestFolder folder;
  {
    OutputFile file(folder.path() / "a");
    file.write("hello");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "a"));
    file.commit();
  }
  EXPECT_EQ(folder.read("a"), "hello");
  EXPECT_EQ(folder.size(), 1);
}

TEST(OutputFile, LeavesTheOldFileAndNoRestWithoutCommit) {
  const TestFolder folder;
  folder.write("a", "old");
  {
    OutputFile file(folder.path() / "a");
    file.write("new");
  }
  EXPECT_EQ(folder.read("a"), "old");
  EXPECT_EQ(folder.size(), 1);
}

TEST(OutputFile, RefusesFoldersAndMissingFolders) {
  const TestFolder folder;
  EXPECT_THROW(OutputFile(folder.path()), std::runtime_error);
  EXPECT_THROW(OutputFile(folder.path() / "missing" / "a"), std::runtime_error);
  EXPECT_THROW(OutputFile(""), std::runtime_error);
}

TEST(OutputFile, FindsAFullDisk) {
  OutputFile file("/dev/full");
  EXPECT_THROW(
      {
        file.write(std::string(1 << 20, 'x'));
        file.commit();
      },
      std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(OutputFile, FindsAFullDiskUnderAPicture) {
  Image image{2, 1, {glm::vec3(0), glm::vec3(1)}};
  OutputFile file("/dev/full");
  EXPECT_THROW(
      {
        write_png(image, file);
        file.commit();
      },
      std::runtime_error);
}

TEST(Image, CutsAndRoundsTo8Bits) {
  const Image image{2, 1, {glm::vec3(-1, 0, 0.5F), glm::vec3(1, 7, 0.2F)}};
  // 255 * 0.5^(1/2.2) = 186.08, 255 * 0.2^(1/2.2) = 122.7
  const std::vector<std::uint8_t> expected{0, 0, 186, 255, 255, 123};
  EXPECT_EQ(to_8_bit(image), expected);
}

TEST(Image, CountsPixelsThatAreOff) {
  EXPECT_EQ(pixels_off({1, 2, 3, 4, 5, 6}, {1, 2, 3, 4, 5, 6}, 0), 0U);
  EXPECT_EQ(pixels_off({1, 2, 3, 4, 5, 6}, {1, 2, 5, 4, 5, 7}, 0), 2U);
  EXPECT_EQ(pixels_off({1, 2, 3, 4, 5, 6}, {1, 2, 6, 4, 5, 8}, 2), 1U);
}

}  // namespace
}  // namespace raplas
