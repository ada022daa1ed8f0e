# docker build -t ros-lint . && docker run --rm -v "$PWD:/workspace:ro" ros-lint
FROM python:3.13-slim AS build
WORKDIR /source
COPY . .
RUN python3 -m venv /opt/ros-lint && /opt/ros-lint/bin/pip install --no-cache-dir .

FROM python:3.13-slim
COPY --from=build /opt/ros-lint /opt/ros-lint
RUN useradd --create-home --uid 1000 lint
ENV PATH=/opt/ros-lint/bin:$PATH
USER 1000
WORKDIR /workspace
ENTRYPOINT ["ros-lint"]
