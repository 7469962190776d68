"""A friction law, an impact law, a body, a shape and a scenario, as a stranger would write them."""

from .body import HollowBall
from .friction import Rubber
from .impact import Softening
from .lens import Lens
from .scenario import HollowBallOnSlope

__all__ = ["HollowBall", "HollowBallOnSlope", "Lens", "Rubber", "Softening"]
