#include "tests/dynamics/rollout/simbody_cpodes.h"

#include <Simbody.h>

namespace possibility::dynamics {

std::vector<double> SwingWithCPodes(double angle, double gravity,
                                    const std::vector<double>& times) {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter(system);
  SimTK::GeneralForceSubsystem forces(system);
  SimTK::Force::UniformGravity weight(forces, matter, SimTK::Vec3(0, -gravity, 0));
  SimTK::Body::Rigid bob(SimTK::MassProperties(1, SimTK::Vec3(0), SimTK::Inertia(0)));
  SimTK::MobilizedBody::Pin pendulum(matter.Ground(), SimTK::Transform(), bob,
                                     SimTK::Transform(SimTK::Vec3(0, 1, 0)));
  SimTK::State state = system.realizeTopology();
  pendulum.setAngle(state, angle);

  SimTK::CPodesIntegrator integrator(system, SimTK::CPodes::Adams, SimTK::CPodes::Functional);
  integrator.setAccuracy(1e-10);
  SimTK::TimeStepper stepper(system, integrator);
  stepper.initialize(state);
  std::vector<double> angles;
  for (const double time : times) {
    stepper.stepTo(time);
    angles.push_back(pendulum.getAngle(stepper.getState()));
  }
  return angles;
}

}  // namespace possibility::dynamics
