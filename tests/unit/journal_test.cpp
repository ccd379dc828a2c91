#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <bit>
#include <chrono>
#include <fstream>
#include <limits>
#include <set>
#include <thread>

#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

using inverse::Journal;
using testing::TemporaryFolder;
using Limits = std::numeric_limits<double>;

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

void write_lines(const std::filesystem::path& file, const std::vector<std::string>& lines, const std::string& torn) {
  std::ofstream stream(file, std::ios::trunc);
  for (const std::string& line : lines) stream << line << '\n';
  stream << torn;
}

TEST(Journal, CutsOffATornLastLine) {
  const TemporaryFolder folder;
  const auto file = folder / "journal.jsonl";
  write_lines(file, {R"({"a":1})", R"({"a":2})"}, R"({"a":3)");
  {
    Journal journal(file);
    ASSERT_EQ(journal.lines().size(), 2u);
    journal.append({{"a", 4}});
  }
  EXPECT_THAT(lines_of(file), ::testing::ElementsAre(R"({"a":1})", R"({"a":2})", R"({"a":4})"));
}

TEST(Journal, RefusesDamageBeforeTheLastLine) {
  const TemporaryFolder folder;
  write_lines(folder / "journal.jsonl", {R"({"a":1})", R"({"a":)", R"({"a":3})"}, "");
  EXPECT_THAT([&] { Journal journal(folder / "journal.jsonl"); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("journal.jsonl:2")));
}

TEST(Journal, IsHeldByOneProcessAtATime) {
  const TemporaryFolder folder;
  {
    const Journal first(folder / "journal.jsonl");
    EXPECT_THAT([&] { Journal second(folder / "journal.jsonl"); },
                ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("another process")));
  }
  EXPECT_NO_THROW(Journal(folder / "journal.jsonl"));
}

/// No file of this process grows over `bytes` while this lives, as on a full disk.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST(Journal, LosesNothingOnAFullDisk) {
  const TemporaryFolder folder;
  const auto file = folder / "journal.jsonl";
  Journal journal(file);
  journal.append({{"a", 1}});
  {
    const SizeLimit limit(20);
    EXPECT_THAT(
        [&] {
          journal.append({{"a", "longer than what is left"}});
        },
        ::testing::ThrowsMessage<InputError>(::testing::AllOf(::testing::HasSubstr("journal.jsonl: cannot write"),
                                                              ::testing::HasSubstr("File too large"))));
    EXPECT_EQ(read_file(file), "{\"a\":1}\n");
  }
  journal.append({{"a", 2}});
  EXPECT_THAT(lines_of(file), ::testing::ElementsAre(R"({"a":1})", R"({"a":2})"));
}

TEST(Journal, KeepsEveryBitOfARecord) {
  inverse::RunRecord record;
  record.F_c = {0.1 + 0.2, Limits::denorm_min()};
  record.F_t = {-0.0, Limits::quiet_NaN()};
  record.chip_ratio = {Limits::infinity(), -Limits::infinity()};
  record.ledger.plastic = std::nextafter(1.0, 2.0);
  record.branch = forward::Branch::bending;
  record.refusals = {"a \"quoted\" cause, with µ"};
  record.result = {{"F_c", {{"value", 0.1 + 0.2}, {"unit", "N/m"}}}, {"chip_ratio", nullptr}};
  const auto text = inverse::to_json(record).dump();
  const inverse::RunRecord back = inverse::record_from_json(nlohmann::ordered_json::parse(text));
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  EXPECT_EQ(bits(back.F_c.value), bits(record.F_c.value));
  EXPECT_EQ(bits(back.F_c.standard_error), bits(record.F_c.standard_error));
  EXPECT_EQ(bits(back.F_t.value), bits(record.F_t.value));
  EXPECT_TRUE(std::isnan(back.F_t.standard_error));
  EXPECT_EQ(back.chip_ratio.value, Limits::infinity());
  EXPECT_EQ(back.chip_ratio.standard_error, -Limits::infinity());
  EXPECT_EQ(bits(back.ledger.plastic), bits(record.ledger.plastic));
  EXPECT_EQ(back.branch, forward::Branch::bending);
  EXPECT_EQ(back.refusals, record.refusals);
  EXPECT_EQ(back.result, record.result);
}

/// All numbers of an answer, to be compared bit for bit.
std::vector<std::uint64_t> bits_of(const inverse::Calibration& calibration) {
  std::vector<std::uint64_t> bits;
  const auto add = [&](const inverse::Identifiability& known) {
    for (const inverse::ParameterEstimate& p : known.parameters)
      for (const double value : {p.value, p.standard_error, p.interval.lower, p.interval.upper})
        bits.push_back(std::bit_cast<std::uint64_t>(value));
    bits.push_back(std::bit_cast<std::uint64_t>(known.chi2));
  };
  add(calibration.fit.identifiability);
  for (const inverse::Fit& fit : calibration.alternatives) add(fit.identifiability);
  return bits;
}

inverse::Job twin(const TemporaryFolder& folder) {
  return testing::write_job(folder, std::string(testing::job_text) + "[edge_force]\n",
                            testing::curve_text({.edge_force = 1}, {0.1, 0.2, 0.4, 0.8}, 0.03, 5));
}

TEST(Resume, ReplaysFromAnyLineToTheSameBits) {
  const TemporaryFolder folder;
  const inverse::Job job = twin(folder);
  const auto whole = testing::calibrate(job, folder / "whole.jsonl");
  ASSERT_TRUE(whole.calibration.fit.converged);
  const std::vector<std::string> lines = lines_of(folder / "whole.jsonl");
  ASSERT_EQ(lines.size(), whole.runs + 1);  // one line names the session
  ASSERT_EQ(whole.simulated, whole.runs);
  for (std::size_t kept = 0; kept <= lines.size(); kept += 7) {
    const auto file = folder / fmt::format("cut_{}.jsonl", kept);
    const std::string torn = kept < lines.size() ? lines[kept].substr(0, lines[kept].size() / 2) : "";
    write_lines(file, {lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(kept)}, torn);
    const auto resumed = testing::calibrate(job, file);
    EXPECT_EQ(bits_of(resumed.calibration), bits_of(whole.calibration)) << kept;
    EXPECT_EQ(resumed.runs, whole.runs);
    EXPECT_EQ(resumed.simulated, whole.runs - (kept == 0 ? 0 : kept - 1)) << "runs were repeated";
  }
}

TEST(Resume, RunsAreSharedBetweenJobs) {
  const TemporaryFolder folder;
  const inverse::Job job = twin(folder);
  const auto alone = testing::calibrate(job, folder / "alone.jsonl");
  const auto sharing = [&](const std::string& journal_file) {
    inverse::Journal journal(folder / journal_file);
    inverse::RunDatabase database(journal, "test", testing::synthetic_cut, 2);
    database.share(folder / "shared");
    auto calibration = inverse::calibrate(job, database);
    return testing::Outcome{std::move(calibration), database.runs(), database.simulated()};
  };
  const auto first = sharing("first.jsonl"), second = sharing("second.jsonl");
  EXPECT_EQ(first.simulated, alone.runs);
  EXPECT_EQ(second.simulated, 0u) << "a run was made twice";
  for (const auto* shared : {&first, &second}) {
    EXPECT_EQ(bits_of(shared->calibration), bits_of(alone.calibration));
    EXPECT_EQ(shared->runs, alone.runs);
  }
  // What came from elsewhere is journaled, so that a resumed calibration needs nothing but its own folder.
  std::filesystem::remove_all(folder / "shared");
  const auto resumed = testing::calibrate(job, folder / "second.jsonl");
  EXPECT_EQ(resumed.simulated, 0u);
  EXPECT_EQ(bits_of(resumed.calibration), bits_of(alone.calibration));
}

TEST(Resume, TheOrderOfParallelRunsDoesNotMatter) {
  const TemporaryFolder folder;
  const inverse::Job job = twin(folder);
  const auto serial = testing::calibrate(job, folder / "serial.jsonl", testing::synthetic_cut, 1);
  std::atomic<unsigned> count = 0;
  const auto uneven = [&](const forward::Scene& scene) {
    std::this_thread::sleep_for(std::chrono::microseconds((count++ * 7919) % 900));
    return testing::synthetic_cut(scene);
  };
  const auto parallel = testing::calibrate(job, folder / "parallel.jsonl", uneven, 5);
  EXPECT_EQ(bits_of(serial.calibration), bits_of(parallel.calibration));
  EXPECT_EQ(serial.runs, parallel.runs);
}

TEST(Resume, SurvivesKill9) {
  const TemporaryFolder folder;
  const inverse::Job job = twin(folder);
  const auto undisturbed = testing::calibrate(job, folder / "undisturbed.jsonl");
  const auto file = folder / "killed.jsonl";
  for (const std::size_t enough : {4u, 15u, 26u}) {  // killed three times on the way
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const auto slow = [](const forward::Scene& scene) {
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
        return testing::synthetic_cut(scene);
      };
      testing::calibrate(job, file, slow);
      ::_exit(0);
    }
    while (lines_of(file).size() < enough) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the calibration ended before it could be killed";
  }
  const auto resumed = testing::calibrate(job, file);
  EXPECT_EQ(bits_of(resumed.calibration), bits_of(undisturbed.calibration));
  EXPECT_LT(resumed.simulated, resumed.runs);
  std::set<std::string> keys;
  std::size_t runs = 0;
  for (const std::string& line : lines_of(file)) {
    const auto json = nlohmann::json::parse(line);
    if (!json.contains("run")) continue;
    ++runs;
    keys.insert(json.at("key").get<std::string>());
  }
  EXPECT_EQ(keys.size(), runs) << "a run was repeated";
  EXPECT_EQ(runs, undisturbed.runs);
}

TEST(Resume, AnInterruptedRunIsNotRemembered) {
  const TemporaryFolder folder;
  const inverse::Job job = twin(folder);
  std::atomic<int> left = 10;
  const auto stopping = [&](const forward::Scene& scene) {
    if (left-- <= 0) throw inverse::Interrupted{};
    return testing::synthetic_cut(scene);
  };
  const auto stopped = testing::calibrate(job, folder / "journal.jsonl", stopping);
  EXPECT_TRUE(stopped.calibration.partial);
  EXPECT_EQ(stopped.calibration.exit_code, ExitCode::interrupted);
  EXPECT_THAT(stopped.calibration.statement, ::testing::HasSubstr("stopped"));
  EXPECT_EQ(lines_of(folder / "journal.jsonl").size(), 11u);
  const auto resumed = testing::calibrate(job, folder / "journal.jsonl");
  EXPECT_EQ(resumed.simulated, resumed.runs - 10);
  EXPECT_FALSE(resumed.calibration.partial);
}

TEST(Resume, BeforeTheFirstPointThereIsNothingToReport) {
  const TemporaryFolder folder;
  const inverse::Job job = twin(folder);
  const auto stopping = [](const forward::Scene&) -> forward::CutResult { throw inverse::Interrupted{}; };
  EXPECT_THROW(testing::calibrate(job, folder / "journal.jsonl", stopping), inverse::Interrupted);
}

}  // namespace
}  // namespace kerf
