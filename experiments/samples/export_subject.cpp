#include "experiments/samples/export_subject.h"

#include "experiments/samples/feed_forward.h"

namespace possibility::experiments {

void VisitSamples(const ExportSubject& subject, const ExportSampling& sampling,
                  const VisitSample& visit) {
  if (!sampling.period) {
    VisitKnots(subject.plan, visit);
    return;
  }
  FeedForward feed_forward(subject.robot);
  VisitEvery(subject.plan, *sampling.period, [&](const PlanSample& interpolated) {
    PlanSample sample = interpolated;
    feed_forward.Complete(&sample);
    visit(sample);
  });
}

}  // namespace possibility::experiments
