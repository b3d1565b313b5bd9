#include "experiments/trials/table_report.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "experiments/report/action_colors.h"
#include "experiments/report/experiment_page.h"
#include "experiments/report/plan_picture.h"
#include "experiments/report/text_table.h"
#include "experiments/trials/experiment_run.h"
#include "experiments/trials/sweep_report.h"
#include "experiments/trials/table_rows.h"
#include "experiments/trials/trial_run.h"
#include "tests/experiments/read_text.h"
#include "tests/experiments/sample_plan.h"
#include "tests/experiments/trials/sample_records.h"
#include "tests/experiments/trials/well_formed.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;
using testing::FailedRecord;
using testing::IsWellFormed;
using testing::ReadText;
using testing::SampleRecord;
using testing::SweepRecord;

/// Two presets of one row of the paper with four trials each, one trial without a plan, and a twin.
TableReport SampleReport() {
  TableReport report;
  for (const char* preset : {"default", "paper"}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      report.trials.push_back(SampleRecord("hallway_3", preset, seed));
    }
    report.trials.push_back(FailedRecord("hallway_3", preset, 4));
  }
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    TrialRecord twin = FailedRecord("closed_room", "default", seed);
    twin.no = "proven_infeasible";
    twin.timings.graph_s = static_cast<double>(seed);
    report.twins.push_back(twin);
  }
  return report;
}

class ReportFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "plans");
  }
  void TearDown() override { fs::remove_all(folder_); }
  const fs::path folder_ =
      fs::temp_directory_path() / ("possibility_report_" + std::to_string(::getpid()));
};

TEST(TableRows, AgreeWithThePaper) {
  ASSERT_EQ(TableRows().size(), 8u);
  double graph = 0, motion = 0, ratio = 0;
  for (const TableRow& row : TableRows()) {
    graph += row.graph.mean + row.graph.std;
    motion += row.motion.mean + row.motion.std;
    ratio += row.real_time_ratio.mean + row.real_time_ratio.std;
    EXPECT_EQ(row.name, row.scenario + "_" + std::to_string(row.actions.size()));
    EXPECT_TRUE(fs::exists(fs::path(POSSIBILITY_SOURCE_DIR) / "experiments/scenarios" /
                           (row.scenario + ".yaml")));
  }
  // Checksums over the columns of the paper's table.
  EXPECT_NEAR(graph, 0.136 + 0.21 + 0.934 + 0.264 + 1.063 + 1.428 + 15.19 + 1.82, 1e-9);
  EXPECT_NEAR(motion, 9.28 + 9.66 + 9.38 + 10.32 + 9.89 + 7.52 + 9.13 + 4.6, 1e-9);
  EXPECT_NEAR(ratio, 146.7 + 146.2 + 146.8 + 145.7 + 145.1 + 128.23 + 134.16 + 119.54, 1e-9);
  for (const std::string& twin : InfeasibleTwins()) {
    EXPECT_TRUE(
        fs::exists(fs::path(POSSIBILITY_SOURCE_DIR) / "experiments/scenarios" / (twin + ".yaml")));
  }
}

TEST(TableReportTest, SummaryHoldsEveryFigureOfRowAndPreset) {
  const auto json = SampleReport().Summary();
  EXPECT_EQ(json["format"], "possibility-table/1");
  ASSERT_EQ(json["rows"].size(), 2u);
  const auto& row = json["rows"][0];
  EXPECT_EQ(row["row"], "hallway_3");
  EXPECT_EQ(row["preset"], "default");
  EXPECT_EQ(row["trials"], 4);
  EXPECT_EQ(row["success"], 0.75);
  EXPECT_EQ(row["verified"], 0.75);
  EXPECT_EQ(row["no"]["time_limit"], 1);
  EXPECT_EQ(row["paper"]["graph_s"]["std"], 11.52);
  for (const char* key :
       {"graph_s", "motion_s", "confirmation_s", "plan_duration_s", "real_time_ratio",
        "verification_s", "memory_mb", "preparation_s", "length_m", "speed_m_s"}) {
    for (const char* part : {"mean", "std", "median", "p95", "max"}) {
      EXPECT_TRUE(row[key][part].is_number()) << key << ' ' << part;
    }
  }
  // The times of the three trials that succeeded: 0.1, 0.2, 0.3 s.
  EXPECT_NEAR(row["graph_s"]["mean"].get<double>(), 0.2, 1e-12);
  EXPECT_NEAR(row["graph_s"]["std"].get<double>(), 0.1, 1e-12);
  EXPECT_NEAR(row["graph_s"]["p95"].get<double>(), 0.3, 1e-12);
  ASSERT_EQ(json["twins"].size(), 1u);
  EXPECT_EQ(json["twins"][0]["no"]["proven_infeasible"], 2);
  EXPECT_NEAR(json["twins"][0]["answer_s"]["max"].get<double>(), 2.5, 1e-12);
}

TEST(TableReportTest, ShortTimesKeepTheirDigits) {
  TrialRecord record = SampleRecord("hallway_3", "default", 1);
  record.timings.graph_s = 0.000154;
  TableReport report;
  report.trials = {record};
  EXPECT_NE(report.Markdown().find("| default | \u2013 | 0.00015 (0.000) |"), std::string::npos)
      << report.Markdown();
}

TEST(TableReportTest, ARowWithoutAPlanHasNoFigures) {
  TableReport report;
  report.trials = {FailedRecord("hallway_3", "default", 1)};
  const auto json = report.Summary();
  EXPECT_EQ(json["rows"][0]["success"], 0);
  EXPECT_TRUE(json["rows"][0]["graph_s"].is_null());
  EXPECT_NE(report.Markdown().find("\u2013"), std::string::npos);
}

TEST(TableReportTest, MarkdownHoldsOurFiguresBesideThePapers) {
  const std::string text = SampleReport().Markdown();
  for (const char* part :
       {"| Hallway | 3 | default | \u2013 | 0.200 (0.100) |", "3.67 (11.52)", "127.2 (6.96)",
        "| 96 % |", "75 %", "our own", "machine \"one\"; machine two", "E3-1290 v2",
        "| hallway_3 | paper | Graph (s) | 0.200 (0.100) | 0.200 | 0.300 | 0.300 |",
        "| closed_room | 2 proven_infeasible | 2 | 2.000 (0.707) | 2.000 | 2.500 | 2.500 |"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
  std::istringstream lines(text);
  std::ptrdiff_t columns = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] != '|') {
      columns = 0;
      continue;
    }
    const std::ptrdiff_t bars = std::count(line.begin(), line.end(), '|');
    EXPECT_TRUE(columns == 0 || bars == columns) << line;
    columns = bars;
  }
}

TEST_F(ReportFolder, TheTablesFilesAreWellFormedAndStandAlone) {
  std::ofstream(folder_ / "plans/hallway_3_default.svg") << "<svg>picture</svg>";
  SampleReport().Write(folder_);
  for (const char* name :
       {"graph_distribution.svg", "motion_distribution.svg", "success.svg", "time_shares.svg"}) {
    EXPECT_TRUE(IsWellFormed(ReadText(folder_ / name))) << name;
  }
  std::string page = ReadText(folder_ / "report.html");
  ASSERT_EQ(page.rfind("<!DOCTYPE html>\n", 0), 0u);
  page = page.substr(page.find('\n') + 1);
  EXPECT_TRUE(IsWellFormed(page));
  EXPECT_EQ(page.find("src=\"http"), std::string::npos);
  EXPECT_EQ(page.find("href="), std::string::npos);
  // Four plots, and a picture of the only plan.
  std::size_t images = 0;
  for (auto at = page.find("<img "); at != std::string::npos; at = page.find("<img ", at + 1)) {
    EXPECT_EQ(page.substr(page.find("src=", at), 31), "src=\"data:image/svg+xml;base64,");
    ++images;
  }
  EXPECT_EQ(images, 5u);
  EXPECT_EQ(nlohmann::ordered_json::parse(ReadText(folder_ / "summary.json")),
            SampleReport().Summary());
  EXPECT_EQ(ReadText(folder_ / "table.md"), SampleReport().Markdown());
}

TEST_F(ReportFolder, TheSweepsFilesAgreeWithEachOther) {
  SweepReport report;
  for (const double value : {0.25, 0.5, 1.0}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      report.trials.push_back(SweepRecord(value, seed, value < 0.9 && (value < 0.4 || seed < 3)));
    }
  }
  report.Write(folder_);
  const auto json = nlohmann::ordered_json::parse(ReadText(folder_ / "summary.json"));
  EXPECT_EQ(json["format"], "possibility-sweep/1");
  EXPECT_EQ(json["parameter"], "gap");
  ASSERT_EQ(json["rows"].size(), 3u);
  const double success[] = {1, 0.5, 0};
  std::istringstream csv(ReadText(folder_ / "sweep.csv"));
  std::string header, line;
  std::getline(csv, header);
  for (int i = 0; i < 3; ++i) {
    const auto& row = json["rows"][i];
    EXPECT_EQ(row["success"], success[i]);
    EXPECT_LE(row["success_interval"][0].get<double>(), success[i]);
    EXPECT_GE(row["success_interval"][1].get<double>(), success[i]);
    ASSERT_TRUE(std::getline(csv, line));
    EXPECT_EQ(std::count(line.begin(), line.end(), ','),
              std::count(header.begin(), header.end(), ','));
    std::istringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    EXPECT_EQ(std::stod(cell), row["value"].get<double>());
    for (int skipped = 0; skipped < 4; ++skipped) std::getline(cells, cell, ',');
    EXPECT_EQ(std::stod(cell), success[i]);
  }
  EXPECT_TRUE(json["rows"][2]["graph_s"].is_null());
  EXPECT_TRUE(IsWellFormed(ReadText(folder_ / "success.svg")));
  EXPECT_TRUE(IsWellFormed(ReadText(folder_ / "times.svg")));
  const std::string page = ReadText(folder_ / "report.html");
  EXPECT_TRUE(IsWellFormed(page.substr(page.find('\n') + 1)));
}

TEST(PlanPictureTest, DrawsObstaclesGraphAndTheRouteByAction) {
  actions::Plan plan = testing::SamplePlan(testing::SampleRobot(), 2, 5);
  plan.explored.vertices[1].position = {0.5, 0.5, 0.8};
  const std::string svg = PlanPicture(plan, testing::SampleScenario().environment);
  EXPECT_TRUE(IsWellFormed(svg));
  EXPECT_NE(svg.find("class=\"ground\""), std::string::npos);
  EXPECT_NE(svg.find("class=\"obstacle\""), std::string::npos);
  EXPECT_NE(svg.find("class=\"route\" stroke=\"" + ActionColor("walk")), std::string::npos);
  EXPECT_NE(svg.find("class=\"route\" stroke=\"" + ActionColor("walk->crawl")), std::string::npos);
  EXPECT_NE(ActionColor("walk"), ActionColor("crawl"));
  EXPECT_TRUE(IsWellFormed(PlanPicture({}, testing::SampleScenario().environment)));
}

TEST(PlanPictureTest, DrawsTheBarrierOfANo) {
  actions::Plan plan;
  plan.no = {"exhausted", "", {}};
  const models::Environment& environment = testing::SampleScenario().environment;
  EXPECT_EQ(PlanPicture(plan, environment).find("class=\"barrier\""), std::string::npos);
  plan.no->barrier = {{1, 0.5}, 2, {"bar"}, {{"walk", 0, {{{0, 0}, {1, 0}, {1, 1}}}}, {"", 0, {}}}};
  const std::string svg = PlanPicture(plan, environment);
  EXPECT_TRUE(IsWellFormed(svg));
  EXPECT_NE(svg.find("class=\"barrier\""), std::string::npos);
  EXPECT_NE(svg.find("class=\"closest\""), std::string::npos);
  EXPECT_NE(svg.find("M0.000,-0.000 1.000,-0.000 1.000,-1.000 Z\" class=\"reached\" fill=\"" +
                     ActionColor("walk")),
            std::string::npos)
      << svg;
}

TEST(TextTableTest, EscapesMarkupInItsCells) {
  TextTable table;
  table.header = {"a|b", "n"};
  table.rows = {{"x<y", "1"}};
  EXPECT_EQ(table.Markdown(), "| a\\|b | n |\n|---|--:|\n| x<y | 1 |\n");
  EXPECT_TRUE(IsWellFormed(table.Html()));
  EXPECT_NE(table.Html().find("x&lt;y"), std::string::npos);
}

TEST(TrialProgressTest, NamesTheTrialsDoneAndTheTimeLeft) {
  EXPECT_EQ(DescribeTrials(0, 400, 0), "trial 0 of 400");
  EXPECT_EQ(DescribeTrials(100, 400, 50), "trial 100 of 400, 2:30 left");
  EXPECT_EQ(DescribeTrials(400, 400, 50), "trial 400 of 400");
}

}  // namespace
}  // namespace possibility::experiments
