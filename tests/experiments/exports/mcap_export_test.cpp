#include "experiments/exports/mcap_export.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "tests/experiments/exports/mcap_reader.h"
#include "tests/experiments/read_text.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

class McapExportTest : public ::testing::Test {
 protected:
  McapExportTest() : robot_(testing::SampleRobot()) {
    robot_.file = POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml";  // for its URDF
  }
  void TearDown() override { std::filesystem::remove(file_); }

  /// Messages by topic.
  std::map<std::string, std::vector<testing::McapMessage>> Messages() const {
    const std::string bytes = testing::ReadText(file_);
    std::map<int, std::string> topics;
    std::map<std::string, std::vector<testing::McapMessage>> messages;
    for (const auto& record : testing::McapRecords(bytes, 8, bytes.size() - 8)) {
      if (record.opcode == 4) {
        testing::McapFields channel(record.content);
        const int id = channel.Take<std::uint16_t>();
        channel.Take<std::uint16_t>();
        topics[id] = channel.Text();
      }
      if (record.opcode != 6) continue;
      const std::string unpacked = testing::UnpackedChunk(record);
      for (const auto& inner : testing::McapRecords(unpacked, 0, unpacked.size())) {
        const testing::McapMessage message = testing::ReadMessage(inner);
        messages[topics[message.channel]].push_back(message);
      }
    }
    return messages;
  }

  models::RobotModel robot_;
  const actions::Plan plan_ = testing::SamplePlan(robot_, 4, 9);
  const models::Scenario scenario_ = testing::SampleScenario();
  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / fmt::format("export_{}.mcap", ::getpid());
};

TEST_F(McapExportTest, HoldsSceneAndUrdfOnceAndTheMotionAtEverySample) {
  WriteMcap({plan_, robot_, scenario_}, {0.1, false}, file_);
  const auto messages = Messages();
  for (const char* topic : {"/scene", "/robot", "/robot_description"}) {
    ASSERT_EQ(messages.at(topic).size(), 1u) << topic;
    EXPECT_EQ(messages.at(topic)[0].time, 0u);
  }
  EXPECT_NE(messages.at("/robot_description")[0].data.find("<robot name"), std::string::npos);
  for (const char* topic : {"/tf", "/joint_states", "/contact_forces", "/contact_force_arrows"}) {
    ASSERT_EQ(messages.at(topic).size(), 41u) << topic;
    EXPECT_EQ(messages.at(topic)[7].time, 700000000u);
    EXPECT_EQ(messages.at(topic)[40].time, 4000000000u);
  }
  EXPECT_EQ(messages.size(), 7u);
}

TEST_F(McapExportTest, WithoutAPeriodThereAreFiftySamplesASecond) {
  WriteMcap({plan_, robot_, scenario_}, {}, file_);
  EXPECT_EQ(Messages().at("/tf").size(), 201u);
}

TEST_F(McapExportTest, AMissingRobotIsNamedAndNothingWritten) {
  robot_.file = "none.yaml";
  EXPECT_THROW(WriteMcap({plan_, robot_, scenario_}, {}, file_), InputError);
  EXPECT_FALSE(std::filesystem::exists(file_));
}

}  // namespace
}  // namespace possibility::experiments
