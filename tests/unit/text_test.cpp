// Small services that the rest leans on: nearest names, hashes, files that are whole or not there.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"
#include "models/base/parameter.hpp"

namespace kerf {
namespace {

namespace fs = std::filesystem;

TEST(Nearest, FindsTheSlipOfThePen) {
  const std::vector<std::string> keys{"strength", "toughness", "rake", "depth", "n"};
  EXPECT_EQ(nearest("strenght", keys), "strength");  // swapped neighbours
  EXPECT_EQ(nearest("Toughness", keys), "toughness");
  EXPECT_EQ(nearest("toughnes", keys), "toughness");
  EXPECT_EQ(nearest("rakee", keys), "rake");
  EXPECT_EQ(nearest("yield", keys), std::nullopt);
  EXPECT_EQ(nearest("", keys), std::nullopt);
  EXPECT_EQ(nearest(std::string(100000, 'x'), keys), std::nullopt);
  EXPECT_EQ(nearest("depth", {}), std::nullopt);
}

TEST(AllowedRange, ReadsLikeASentence) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(allowed_range(number("k", "MPa", 1e-3, 1e5, "")), "0.001 to 100000 MPa");
  EXPECT_EQ(allowed_range(number("k", "1", 0, infinity, "")), "at least 0");
  EXPECT_EQ(allowed_range(number("k", "mm", -infinity, 3, "")), "at most 3 mm");
  EXPECT_EQ(allowed_range(number("k", "1", -infinity, infinity, "")), "any number");
}

TEST(Sha256, AgreesWithThePublishedVectors) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

class AtomicFile : public ::testing::Test {
 protected:
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  // Tests run at the same time, each with a folder of its own.
  const fs::path folder_ =
      fs::path(::testing::TempDir()) /
      (std::string("kerf_atomic_file_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(AtomicFile, ReplacesTheWholeContentAndLeavesNothingBeside) {
  const fs::path file = folder_ / "deep" / "result.json";
  write_atomically(file, "first");
  write_atomically(file, "second");
  EXPECT_EQ(read_file(file), "second");
  EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), fs::directory_iterator()), 1);
}

TEST_F(AtomicFile, ReadersNeverSeeAPart) {
  const fs::path file = folder_ / "log";
  const std::string a(200000, 'a'), b(300000, 'b');
  write_atomically(file, a);
  std::thread writer([&] {
    for (int i = 0; i < 20; ++i) write_atomically(file, i % 2 ? a : b);
  });
  int torn = 0;
  for (int i = 0; i < 200; ++i) {
    const std::string content = read_file(file);
    torn += content != a && content != b;
  }
  writer.join();
  EXPECT_EQ(torn, 0);
}

TEST_F(AtomicFile, SaysWhyAPlaceCannotBeWritten) {
  write_atomically(folder_ / "file", "x");
  EXPECT_THROW(write_atomically(folder_ / "file" / "below", "x"), InputError);
  EXPECT_THROW(read_file(folder_ / "absent"), InputError);
  EXPECT_THROW(read_file(folder_), InputError);
}

}  // namespace
}  // namespace kerf
