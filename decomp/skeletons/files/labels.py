"""Names of sites that tell them apart."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from decomp.sites.site import Site


def site_labels(sites: Sequence[Site]) -> tuple[str, ...]:
    """A label for each site, unique within its region.

    Two faces may share several edges, which then have one name: the second becomes `name@2`, and so
    on, in the order of the sites.
    """
    seen: Counter[tuple[int, str]] = Counter()
    labels = []
    for site in sites:
        seen[site.region, site.name] += 1
        count = seen[site.region, site.name]
        labels.append(site.name if count == 1 else f"{site.name}@{count}")
    return tuple(labels)
