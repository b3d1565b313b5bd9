#include <dlfcn.h>
#include <elf.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "dynamics/ode/ode_integrator.h"
#include "tests/dynamics/rollout/simbody_cpodes.h"

namespace possibility::dynamics {
namespace {

constexpr double kGravityHere = 9.81;

/// The period of a point pendulum of length 1 m released at rest.
double Period(double angle) {
  return 4 / std::sqrt(kGravityHere) * std::comp_ellint_1(std::sin(angle / 2));
}

std::vector<double> SwingWithCvode(double angle, const std::vector<double>& times) {
  OdeProblem problem;
  problem.rate = [](double, const auto& x, auto rate) {
    rate << x[1], -kGravityHere * std::sin(x[0]);
  };
  problem.start = Eigen::Vector2d(angle, 0);
  problem.end_time = times.back();
  OdeSettings settings;
  settings.relative_tolerance = settings.absolute_tolerance = 1e-11;
  const OdeTrajectory trajectory = Integrate(problem, settings).trajectory;
  std::vector<double> angles;
  for (const double time : times) angles.push_back(trajectory.State(time)[0]);
  return angles;
}

void ExpectPeriodic(double angle, const std::vector<double>& angles) {
  EXPECT_NEAR(angles[0], 0, 1e-7) << "a quarter period";
  EXPECT_NEAR(angles[1], -angle, 1e-7) << "half a period";
  EXPECT_NEAR(angles[2], angle, 1e-7) << "a period";
}

std::vector<double> QuarterHalfAndWholePeriod(double angle) {
  return {Period(angle) / 4, Period(angle) / 2, Period(angle)};
}

TEST(SimbodyAndSundials, BothIntegrateCorrectlyInOneProcess) {
  for (const double angle : {0.3, 1.2, 2.5}) {
    const std::vector<double> times = QuarterHalfAndWholePeriod(angle);
    ExpectPeriodic(angle, SwingWithCvode(angle, times));
    ExpectPeriodic(angle, SwingWithCPodes(angle, kGravityHere, times));
    ExpectPeriodic(angle, SwingWithCvode(angle, times));
  }
}

TEST(SimbodyAndSundials, BothIntegrateAtTheSameTime) {
  const double angle = 1.7;
  const std::vector<double> times = QuarterHalfAndWholePeriod(angle);
  std::vector<double> cpodes, cvode;
  {
    std::jthread simbody([&] { cpodes = SwingWithCPodes(angle, kGravityHere, times); });
    std::jthread sundials([&] { cvode = SwingWithCvode(angle, times); });
  }
  ExpectPeriodic(angle, cpodes);
  ExpectPeriodic(angle, cvode);
}

/// Names of the symbols that a shared library defines for others, from its ELF file.
std::vector<std::string> ExportedSymbols(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  const auto at = [&bytes]<typename T>(size_t offset, T* value) {
    ASSERT_LE(offset + sizeof(T), bytes.size());
    std::memcpy(value, bytes.data() + offset, sizeof(T));
  };
  Elf64_Ehdr header{};
  at(0, &header);
  std::vector<Elf64_Shdr> sections(header.e_shnum);
  for (size_t i = 0; i < sections.size(); ++i) {
    at(header.e_shoff + i * header.e_shentsize, &sections[i]);
  }
  std::vector<std::string> names;
  for (const Elf64_Shdr& section : sections) {
    if (section.sh_type != SHT_DYNSYM) continue;
    for (size_t offset = 0; offset < section.sh_size; offset += sizeof(Elf64_Sym)) {
      Elf64_Sym symbol{};
      at(section.sh_offset + offset, &symbol);
      if (symbol.st_shndx == SHN_UNDEF) continue;
      names.emplace_back(bytes.c_str() + sections[section.sh_link].sh_offset + symbol.st_name);
    }
  }
  return names;
}

TEST(SimbodyAndSundials, TheSharedLibraryExportsNothingOfSundials) {
  const std::vector<std::string> names = ExportedSymbols(POSSIBILITY_ODE_LIBRARY);
  bool shows_its_own = false;
  for (const std::string& name : names) {
    // Every C++ name is mangled; SUNDIALS is C.
    EXPECT_TRUE(name.starts_with("_") && !name.starts_with("_SUN")) << name;
    shows_its_own |= name.find("possibility8dynamics9Integrate") != std::string::npos;
  }
  EXPECT_TRUE(shows_its_own) << names.size() << " symbols";
}

TEST(SimbodyAndSundials, SundialsSymbolsCannotBeLookedUp) {
  void* library = dlopen(POSSIBILITY_ODE_LIBRARY, RTLD_NOW | RTLD_NOLOAD);
  ASSERT_NE(library, nullptr) << dlerror();
  for (const char* name :
       {"CVode", "CVodeCreate", "CVodeInit", "CVodeGetDky", "N_VNew_Serial", "SUNContext_Create",
        "SUNDenseMatrix", "SUNLinSol_Dense", "SUNNonlinSol_FixedPoint"}) {
    EXPECT_EQ(dlsym(library, name), nullptr) << name;
  }
  // Simbody's own copy is what could be mixed up. Without it this file would test nothing.
  EXPECT_NE(dlsym(RTLD_DEFAULT, "N_VNew_Serial"), nullptr);
  dlclose(library);
}

}  // namespace
}  // namespace possibility::dynamics
