#include "forward/record/cut_file.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>

#include "forward/record/result_json.hpp"
#include "models/base/error.hpp"
#include "tests/unit/sample_cut.hpp"

namespace kerf::forward {
namespace {

namespace fs = std::filesystem;

Document verification_scene() {
  return Document::load(fs::path(KERF_SOURCE_DIR) / "data/scenes/verification_45.toml");
}

/// Reads with the plain C interface: nothing of the writer is trusted.
class Reader {
 public:
  explicit Reader(const fs::path& h5) : file_(H5Fopen(h5.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  ~Reader() { H5Fclose(file_); }

  bool open() const { return file_ >= 0; }
  bool has(const std::string& path) const {
    const hid_t dataset = H5Dopen2(file_, path.c_str(), H5P_DEFAULT);
    if (dataset >= 0) H5Dclose(dataset);
    return dataset >= 0;
  }
  std::vector<hsize_t> extent(const std::string& path) const {
    const hid_t dataset = H5Dopen2(file_, path.c_str(), H5P_DEFAULT), space = H5Dget_space(dataset);
    std::vector<hsize_t> dims(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, dims.data(), nullptr);
    H5Sclose(space);
    H5Dclose(dataset);
    return dims;
  }
  std::vector<double> numbers(const std::string& path) const {
    std::size_t size = 1;
    for (const hsize_t n : extent(path)) size *= n;
    std::vector<double> values(size);
    const hid_t dataset = H5Dopen2(file_, path.c_str(), H5P_DEFAULT);
    EXPECT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << path;
    H5Dclose(dataset);
    return values;
  }
  std::string attribute(const std::string& object, const char* name) const {
    const hid_t attribute = H5Aopen_by_name(file_, object.c_str(), name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return "(no attribute)";
    const hid_t type = H5Aget_type(attribute);
    char* text = nullptr;
    EXPECT_GE(H5Aread(attribute, type, &text), 0);
    std::string copy = text;
    H5free_memory(text);
    H5Tclose(type);
    H5Aclose(attribute);
    return copy;
  }

 private:
  hid_t file_;
};

class CutFile : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_ = fs::path(testing::TempDir()) /
                     ("kerf_cut_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(CutFile, GivesBackWhatWasWritten) {
  const CutResult cut = sample_cut();
  const fs::path h5 = folder_ / "new" / "cut.h5";
  write_cut(h5, verification_scene(), cut);

  const Reader file(h5);
  ASSERT_TRUE(file.open());
  const auto travel = file.numbers("/history/travel"), F_c = file.numbers("/history/F_c"),
             F_t = file.numbers("/history/F_t"), bottom = file.numbers("/history/bottom_tangential"),
             plastic = file.numbers("/history/ledger/plastic"), residue = file.numbers("/history/ledger/residue");
  ASSERT_EQ(travel.size(), cut.history.size());
  for (std::size_t i = 0; i < travel.size(); ++i) {
    EXPECT_EQ(travel[i], cut.history[i].travel);
    EXPECT_EQ(F_c[i], cut.history[i].F_c);
    EXPECT_EQ(F_t[i], cut.history[i].F_t);
    EXPECT_EQ(bottom[i], cut.history[i].face[static_cast<std::size_t>(ToolFace::bottom)].tangential);
    EXPECT_EQ(plastic[i], cut.history[i].ledger.plastic);
    EXPECT_EQ(residue[i], cut.history[i].ledger.residue());
  }

  const std::size_t n = cut.snapshot.x.size();
  ASSERT_EQ(file.extent("/particles/position"), (std::vector<hsize_t>{n, 2}));
  ASSERT_EQ(file.extent("/particles/velocity"), (std::vector<hsize_t>{n, 3}));
  const auto position = file.numbers("/particles/position"), velocity = file.numbers("/particles/velocity"),
             side = file.numbers("/particles/side");
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(position[2 * i], cut.snapshot.x[i]);
    EXPECT_EQ(position[2 * i + 1], cut.snapshot.y[i]);
    EXPECT_EQ(velocity[3 * i + 1], cut.snapshot.velocity_y[i]);
    EXPECT_EQ(velocity[3 * i + 2], 0);
    EXPECT_EQ(side[i], cut.snapshot.side[i]);
  }
  EXPECT_EQ(file.numbers("/particles/plastic_strain"), cut.snapshot.plastic_strain);
  EXPECT_EQ(file.numbers("/tool/tip_x").front(), cut.snapshot.tool_tip_x);
  EXPECT_NEAR(file.numbers("/tool/rake").front(), 3.14159265358979 / 4, 1e-12);
}

TEST_F(CutFile, SaysUnitsSceneAndResult) {
  const fs::path h5 = folder_ / "cut.h5";
  write_cut(h5, verification_scene(), sample_cut());
  const Reader file(h5);
  ASSERT_TRUE(file.open());
  EXPECT_EQ(file.attribute("/history/F_c", "unit"), "N/mm");
  EXPECT_EQ(file.attribute("/history/ledger/fracture", "unit"), "N mm/mm");
  EXPECT_EQ(file.attribute("/particles/pressure", "unit"), "MPa");
  EXPECT_EQ(file.attribute("/", "title"), read_scene(verification_scene()).title);
  EXPECT_EQ(file.attribute("/", "scene"), verification_scene().canonical());
  EXPECT_FALSE(file.attribute("/", "code_version").empty());
  EXPECT_EQ(nlohmann::ordered_json::parse(file.attribute("/", "result")), result_json(sample_cut()));
}

TEST_F(CutFile, XdmfIsWellFormedAndNamesDatasetsThatExist) {
  const fs::path h5 = folder_ / "cut & more.h5";
  write_cut(h5, verification_scene(), sample_cut());
  std::stringstream text;
  text << std::ifstream(xdmf_beside(h5)).rdbuf();
  const std::string xml = text.str();

  const std::string parse = "/usr/bin/python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' ";
  EXPECT_EQ(std::system((parse + "'" + xdmf_beside(h5).string() + "'").c_str()), 0) << "not well-formed:\n" << xml;

  const Reader file(h5);
  ASSERT_TRUE(file.open());
  const std::regex item(R"re(Dimensions="(\d+)(?: (\d+))?"[^>]*>cut &amp; more\.h5:([^<]+)<)re");
  int items = 0;
  for (auto match = std::sregex_iterator(xml.begin(), xml.end(), item); match != std::sregex_iterator(); ++match) {
    const std::string dataset = (*match)[3];
    ASSERT_TRUE(file.has(dataset)) << dataset;
    std::vector<hsize_t> dims{std::stoull((*match)[1])};
    if ((*match)[2].matched) dims.push_back(std::stoull((*match)[2]));
    EXPECT_EQ(file.extent(dataset), dims) << dataset;
    ++items;
  }
  EXPECT_EQ(items, 8);  // position and five attributes of the particles, two crack faces
}

TEST_F(CutFile, KeepsARunThatFailedBeforeItsFirstCrossing) {
  const fs::path h5 = folder_ / "empty.h5";
  CutResult nothing;
  nothing.refusals = {"diverged at step 3"};
  write_cut(h5, verification_scene(), nothing);
  const Reader file(h5);
  ASSERT_TRUE(file.open());
  EXPECT_EQ(file.extent("/history/F_c"), (std::vector<hsize_t>{0}));
  EXPECT_NE(file.attribute("/", "result").find("diverged at step 3"), std::string::npos);
}

TEST_F(CutFile, LeavesNothingBehindWhereItCannotWrite) {
  fs::create_directories(folder_ / "cut.h5");  // a directory is in the way
  EXPECT_THROW(write_cut(folder_ / "cut.h5", verification_scene(), sample_cut()), InputError);
  std::ofstream(folder_ / "file") << "not a directory";
  EXPECT_THROW(write_cut(folder_ / "file" / "cut.h5", verification_scene(), sample_cut()), InputError);
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator(folder_)) left.push_back(entry.path().filename());
  std::sort(left.begin(), left.end());
  EXPECT_EQ(left, (std::vector<std::string>{"cut.h5", "file"}));
}

}  // namespace
}  // namespace kerf::forward
