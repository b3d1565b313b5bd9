#include "common/cancellation_token.h"

#include <utility>

namespace possibility {

CancellationToken::CancellationToken(const Deadline& deadline)
    : CancellationToken(std::function<bool()>([deadline] { return !deadline.Passed(); })) {}

CancellationToken::CancellationToken(std::function<bool()> proceed) {
  if (proceed) proceed_ = std::make_shared<const std::function<bool()>>(std::move(proceed));
}

}  // namespace possibility
