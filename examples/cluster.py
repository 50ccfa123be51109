"""cluster.py A B [HOST:PORT]: how many of 100,000 random poses of B meet A, on a dask.distributed cluster.

HOST:PORT is the address of `dask-scheduler`; each machine runs `dask-worker HOST:PORT`, and can read the files A and B.
Without it, two processes of this machine are the cluster.
"""

import sys

import distributed
import lrbscope
import numpy as np
from lrbscope.many import on_cluster

POSES, CHUNK = 100_000, 5_000


def poses(reach):
    """Yield translations within a cube, as they could come from a file or a sampler."""
    random = np.random.default_rng(1)
    for _ in range(POSES):
        pose = np.eye(4)
        pose[:3, 3] = random.uniform(-reach, reach, 3)
        yield pose


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit("usage: cluster.py A B [HOST:PORT]")
    a, b = sys.argv[1:3]
    reach = np.linalg.norm(lrbscope.Body.load(a).vertices, axis=1).max()
    with distributed.Client(*sys.argv[3:], **({} if sys.argv[3:] else {"n_workers": 2})) as client:
        meet = 0
        for answers in on_cluster(client, lrbscope.collide, a, b, poses(reach), chunk=CHUNK, mode="any"):
            meet += int((answers["relations"] != "separate").sum())
            print(f"{meet} poses meet so far", flush=True)
