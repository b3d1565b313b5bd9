#include "experiments/trials/results_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "experiments/trials/merge.h"
#include "experiments/trials/shard.h"
#include "models/input/input_error.h"
#include "tests/experiments/read_text.h"
#include "tests/experiments/trials/sample_records.h"
#include "tests/message_of.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;
using testing::FailedRecord;
using testing::ReadText;
using testing::SampleRecord;

class Results : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void Write(const std::string& text) const { std::ofstream(file_, std::ios::binary) << text; }

  const fs::path folder_ =
      fs::temp_directory_path() / ("possibility_results_" + std::to_string(::getpid()));
  const fs::path file_ = folder_ / "results.jsonl";
  const std::vector<TrialRecord> records_ = {SampleRecord("a", "default", 1),
                                             SampleRecord("a", "paper", 1),
                                             FailedRecord("b", "paper", 1)};
};

TEST_F(Results, AppendedLinesAreReadBackInOrder) {
  {
    ResultsFile results(file_);
    for (const TrialRecord& record : records_) results.Append(record);
    // The file is still open: a line is there as soon as it is appended.
    EXPECT_EQ(ReadText(file_), FormatResults(records_));
  }
  const std::vector<TrialRecord> back = ReadResults(file_);
  EXPECT_EQ(FormatResults(back), FormatResults(records_));
}

TEST_F(Results, AHalfWrittenLastLineIsCutOffWhereverItBroke) {
  const std::string whole = FormatResults(records_);
  const std::size_t begin = FormatResults({records_[0], records_[1]}).size();
  for (std::size_t size = begin; size < whole.size(); size += size + 3 < whole.size() ? 7 : 1) {
    Write(whole.substr(0, size));
    ResultsFile results(file_);
    ASSERT_EQ(results.records().size(), 2u) << size;
    EXPECT_FALSE(results.Contains(records_[2].key));
    results.Append(records_[2]);
    EXPECT_EQ(ReadText(file_), whole) << size;
  }
}

TEST_F(Results, ALastLineOfGarbageIsCutOffToo) {
  Write(FormatResults({records_[0]}) + std::string(40, '\0') + "\n");
  ResultsFile results(file_);
  EXPECT_EQ(results.records().size(), 1u);
  EXPECT_EQ(ReadText(file_), FormatResults({records_[0]}));
}

TEST_F(Results, DamageElsewhereIsAnErrorThatNamesTheLine) {
  const std::string good = FormatResults({records_[0]}), other = FormatResults({records_[1]});
  for (const std::string& bad : {std::string("{\"row\": \"a\"}\n"), std::string("[]\n"),
                                 std::string("{half\n"), std::string("\n"), good}) {
    Write(good + bad + other);
    const std::string error = MessageOf<InputError>([&] { ResultsFile results(file_); });
    EXPECT_EQ(error.rfind(file_.string() + ":2: ", 0), 0u) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
    EXPECT_EQ(ReadText(file_), good + bad + other) << "nothing is thrown away";
  }
}

TEST_F(Results, TwoProgramsDoNotWriteTheSameFile) {
  ResultsFile results(file_);
  EXPECT_NE(MessageOf<InputError>([&] { ResultsFile second(file_); }).find("another program"),
            std::string::npos);
  EXPECT_NE(MessageOf<InputError>([&] { ResultsFile second(folder_ / "none" / "file"); }),
            "no error");
}

TEST_F(Results, ResultsOfAnotherExperimentAreRefused) {
  {
    ResultsFile results(file_);
    for (const TrialRecord& record : records_) results.Append(record);
  }
  const ResultsFile results(file_);
  std::map<std::string, TrialIdentity> rows = {{"a", records_[0].identity},
                                               {"b", records_[2].identity}};
  EXPECT_NO_THROW(results.RequireSame(rows));
  const auto error = [&](const char* row, std::string TrialIdentity::*member) {
    auto changed = rows;
    for (auto& [name, identity] : changed) {
      if (*row == '\0' || name == row) identity.*member += "x";
    }
    return MessageOf<InputError>([&] { results.RequireSame(changed); });
  };
  EXPECT_NE(error("", &TrialIdentity::experiment).find(":1: "), std::string::npos);
  EXPECT_NE(error("", &TrialIdentity::settings_hash).find("settings"), std::string::npos);
  EXPECT_NE(error("a", &TrialIdentity::scenario_hash).find("scenario"), std::string::npos);
  EXPECT_NE(error("b", &TrialIdentity::robot_hash).find(":3: row 'b' comes from another robot"),
            std::string::npos);
}

TEST_F(Results, ManyThreadsAppendWholeLines) {
  {
    ResultsFile results(file_);
    std::vector<std::jthread> threads;
    for (std::uint64_t t = 0; t < 4; ++t) {
      threads.emplace_back([&results, t] {
        for (std::uint64_t i = 0; i < 25; ++i) {
          results.Append(SampleRecord("a", "default", 100 * t + i));
        }
      });
    }
    threads.clear();
    results.Sort({"a"});
  }
  const std::vector<TrialRecord> back = ReadResults(file_);
  ASSERT_EQ(back.size(), 100u);
  EXPECT_TRUE(std::is_sorted(back.begin(), back.end(),
                             [](const auto& a, const auto& b) { return a.key.seed < b.key.seed; }));
}

TEST_F(Results, MergedShardsEqualOneRun) {
  std::vector<TrialRecord> whole;
  for (const char* row : {"a", "b", "c"}) {
    for (std::uint64_t seed = 1; seed <= 7; ++seed) {
      whole.push_back(SampleRecord(row, "default", seed));
    }
  }
  for (int count = 1; count <= 5; ++count) {
    std::vector<std::pair<fs::path, std::vector<TrialRecord>>> parts;
    for (int k = count - 1; k >= 0; --k) {
      parts.emplace_back(std::to_string(k), std::vector<TrialRecord>{});
      for (std::size_t i = 0; i < whole.size(); ++i) {
        if (Shard{k, count}.Has(i)) parts.back().second.push_back(whole[i]);
      }
    }
    parts.push_back(parts.front());  // the same part twice is allowed
    std::vector<TrialRecord> merged = MergeRecords(parts);
    SortRecords({"a", "b", "c"}, &merged);
    EXPECT_EQ(FormatResults(merged), FormatResults(whole));
  }
}

TEST_F(Results, MergingRefusesResultsOfDifferentRuns) {
  const auto error = [&](auto change) {
    TrialRecord other = SampleRecord("a", "default", 2);
    change(&other);
    return MessageOf<InputError>([&] { MergeRecords({{"one", {records_[0]}}, {"two", {other}}}); });
  };
  EXPECT_EQ(error([](TrialRecord*) {}), "no error");
  EXPECT_EQ(error([](TrialRecord* r) { r->identity.settings_hash = "x"; }),
            "two: row 'a', preset 'default', seed 2: another experiment or other settings than in "
            "one");
  EXPECT_NE(error([](TrialRecord* r) { r->identity.scenario_hash = "x"; }).find("scenario"),
            std::string::npos);
  EXPECT_NE(error([](TrialRecord* r) { r->key.seed = 1; }).find("another outcome"),
            std::string::npos);
  TrialRecord slower = records_[0];
  slower.timings.graph_s *= 2;
  const auto merged = MergeRecords({{"one", {records_[0]}}, {"two", {slower}}});
  ASSERT_EQ(merged.size(), 1u);
  EXPECT_EQ(merged[0].timings.graph_s, records_[0].timings.graph_s);
}

}  // namespace
}  // namespace possibility::experiments
