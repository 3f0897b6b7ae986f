#!/usr/bin/env python3
"""Shares the frames of `hachure fly`, or the drawings of `hachure batch`, out to the GPUs of a Ray cluster.

    ray_driver.py --frames 0-249 --range 25 --workers 8 -- \\
        hachure fly /shared/my-dem.tif --path /shared/route.gpx --count 250 -o /shared/frames/%05d.png

One actor holds one GPU and one `hachure --serve`, warm from range to range. A hachure that ends with 75 (its device was lost,
it was asked to end) or is killed is started again, at most three times a range; an actor that dies is made anew by Ray, and the
hachure that it had ends by itself, for nobody reads its answers. What was drawn before is skipped. The end is
`hachure merge /shared/frames`: whether all is there.

Paths must mean the same on all machines. Ray's GPUs must be all of a machine's, or those that Vulkan sees there: an actor
takes the adapter whose number is that of its GPU, one to one whatever order each counts in.
"""

import argparse
import json
import subprocess
import sys

import ray
from ray.util import ActorPool

TRIES = 1 + 3
TRY_AGAIN = 75


@ray.remote(max_restarts=3, max_task_retries=3)
class Worker:
    """One GPU and its hachure."""

    def __init__(self, command):
        gpus = ray.get_gpu_ids()
        self.command = command + ["--serve"] + (["--adapter", str(gpus[0])] if gpus else [])
        self.hachure = None

    def make(self, frames):
        """The answer to a range of frames."""
        for _ in range(TRIES):
            answer, code = self.ask({"id": frames, "frames": frames})
            if code != TRY_AGAIN and code >= 0:
                break
        return answer or {"id": frames, "ok": False, "exit": code, "error": f"hachure ended with {code}: see its own words"}

    def ask(self, job):
        """The answer, if there is one, and the code with which the job, or else hachure, ended: negative where a signal did it."""
        if self.hachure is None:
            self.hachure = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        try:
            self.hachure.stdin.write(json.dumps(job) + "\n")
            self.hachure.stdin.flush()
            line = self.hachure.stdout.readline()
        except BrokenPipeError:
            line = ""
        answer = json.loads(line) if line.endswith("\n") else None
        if answer and answer.get("exit") != TRY_AGAIN:
            return answer, answer.get("exit", 0)
        code = self.end()
        return answer, TRY_AGAIN if answer else code

    def end(self):
        """Ends hachure, if it runs; its exit code."""
        hachure, self.hachure = self.hachure, None
        if hachure is None:
            return 0
        try:
            hachure.stdin.close()
        except BrokenPipeError:
            pass
        return hachure.wait()


def ranges(frames, length):
    """`0-249` as `0-24`, `25-49` and so on."""
    first, last = (int(end) for end in frames.split("-"))
    return [f"{start}-{min(start + length - 1, last)}" for start in range(first, last + 1, length)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", required=True, metavar="FIRST-LAST", help="the frames or drawings, from 0 on")
    parser.add_argument("--range", type=int, default=25, metavar="N", help="frames of a job (25)")
    parser.add_argument("--workers", type=int, metavar="N", help="actors (as many as the cluster has GPUs)")
    parser.add_argument("--no-gpu", action="store_true", help="actors that hold no GPU: software drivers")
    parser.add_argument("command", nargs="+", metavar="-- hachure …")
    asked = parser.parse_args()
    # Standard output is for answers; what Ray and hachure say goes to standard error.
    answers, sys.stdout = sys.stdout, sys.stderr
    ray.init()
    workers = asked.workers or int(ray.cluster_resources().get("GPU", 0))
    if not workers:
        sys.exit("the cluster has no GPU; give --workers N, with --no-gpu for software drivers")
    held = {"num_gpus": 0 if asked.no_gpu else 1, "num_cpus": 1}
    actors = [Worker.options(**held).remote(asked.command) for _ in range(workers)]
    failed = 0
    jobs = ranges(asked.frames, asked.range)
    for answer in ActorPool(actors).map_unordered(lambda actor, job: actor.make.remote(job), jobs):
        failed += not answer["ok"]
        print(json.dumps(answer), file=answers, flush=True)
    ray.get([actor.end.remote() for actor in actors])
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
