"""The interior skeleton: maximal inscribed balls, and points at equal distance from sites."""
